"""Contacts of a model from those declared: ``"all"`` and lists of bodies become surfaces with each other, and a contact
with each tool.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from softway.contact.contact import Contact
from softway.errors import InputError


def resolved(contacts: Sequence[Contact], solids: Collection[str], tools: Collection[str]) -> tuple[Contact, ...]:
    """Contacts whose members are all named: each of one solid and a tool, or of solids only.

    Those with the tools of a list follow the declared ones, so that the numbers of the declared ones stay.

    Raises
    ------
    InputError
        If a list has no solid; the place begins with ``contacts[k]``.

    Examples
    --------
    >>> for contact in resolved([Contact(between="all")], solids=["ball", "plate"], tools=["floor"]):
    ...     print(contact.label, contact.names)
    all ('ball', 'ball', 'plate', 'plate')
    ball-floor ('ball', 'floor')
    plate-floor ('plate', 'floor')
    """
    own: list[Contact] = []
    with_tools: list[Contact] = []
    given = {frozenset(c.bodies) for c in contacts if not c.many}
    for k, contact in enumerate(contacts):
        if not contact.many:
            own.append(contact)
            continue
        names = contact.names or tuple(name for solid in solids for name in (solid, solid)) + tuple(tools)
        mine = tuple(name for name in names if name not in tools)
        if not mine:
            raise InputError(f"contacts[{k}].between", f"{list(names)} has no solid", "at least one solid")
        found = _with_tools(contact, mine, [n for n in names if n in tools])
        met = [c for c in found if frozenset(c.bodies) not in given]
        given |= {frozenset(c.bodies) for c in met}
        own.append(replace(contact, between=mine, name=contact.label) if len(mine) > 1 else met.pop(0))
        with_tools += met
    return (*own, *with_tools)


def _with_tools(contact: Contact, solids: Sequence[str], tools: Sequence[str]) -> Iterator[Contact]:
    """Contacts of each of the solids with each of the tools."""
    for tool in tools:
        for solid in dict.fromkeys(solids):
            yield replace(contact, between=(solid, tool), name="", method=None)
