"""Contacts of a model from those declared: ``"all"`` and lists of bodies become surfaces with each other, and a contact
with each tool.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from softway.contact.contact import Contact
from softway.errors import InputError


def resolved(
    contacts: Sequence[Contact], solids: Collection[str], tools: Collection[str]
) -> tuple[tuple[int, Contact], ...]:
    """Contacts whose members are all named, each of one solid and a tool, or of solids only, and the number of the
    declared contact of which each is a part.

    Those with the tools of a list follow the declared ones, so that the numbers of the declared ones stay.

    Raises
    ------
    InputError
        If a list has no solid, or only pairs of other contacts; the place begins with ``contacts[k]``.

    Examples
    --------
    >>> for number, contact in resolved([Contact(between="all")], solids=["ball", "plate"], tools=["floor"]):
    ...     print(number, contact.label, contact.names)
    0 all ('ball', 'ball', 'plate', 'plate')
    0 ball-floor ('ball', 'floor')
    0 plate-floor ('plate', 'floor')
    """
    own: list[tuple[int, Contact]] = []
    with_tools: list[tuple[int, Contact]] = []
    given = {frozenset(c.bodies) for c in contacts if not c.many}
    for k, contact in enumerate(contacts):
        if not contact.many:
            own.append((k, contact))
            continue
        names = contact.names or tuple(name for solid in solids for name in (solid, solid)) + tuple(tools)
        mine = tuple(name for name in names if name not in tools)
        if not mine:
            raise InputError(f"contacts[{k}].between", f"{list(names)} has no solid", "at least one solid")
        found = _with_tools(contact, mine, [n for n in names if n in tools])
        met = [(k, c) for c in found if frozenset(c.bodies) not in given]
        given |= {frozenset(c.bodies) for _, c in met}
        if len(mine) == 1 and not met:
            problem = f"{list(names)}: another contact is of each of these pairs"
            raise InputError(f"contacts[{k}].between", problem, "leave this contact out")
        own.append((k, replace(contact, between=mine, name=contact.label)) if len(mine) > 1 else met.pop(0))
        with_tools += met
    return (*own, *with_tools)


def _with_tools(contact: Contact, solids: Sequence[str], tools: Sequence[str]) -> Iterator[Contact]:
    """Contacts of each of the solids with each of the tools."""
    for tool in tools:
        for solid in dict.fromkeys(solids):
            yield replace(contact, between=(solid, tool), name="", method=None)


@contextmanager
def at_declared(numbers: Sequence[int]) -> Iterator[None]:
    """Name the declared contact in the place of an :class:`~softway.errors.InputError` raised inside: ``numbers`` are
    those of the resolved contacts.

    Examples
    --------
    >>> try:
    ...     with at_declared((0, 0, 0)):
    ...         raise InputError("contacts[2].start", "starts inside")
    ... except InputError as error:
    ...     print(error)
    contacts[0].start: starts inside
    """
    try:
        yield
    except InputError as error:
        counted = re.match(r"contacts\[(\d+)\]", error.where)
        k = int(counted[1]) if counted else len(numbers)
        if k >= len(numbers) or numbers[k] == k or counted is None:
            raise
        place = f"contacts[{numbers[k]}]{error.where[counted.end() :]}"
        raise InputError(place, error.problem, error.remedy) from None
