"""Comparison of classes with protocols."""

from dataclasses import fields, is_dataclass
from typing import Any, Generic, Protocol


def asked(protocol: type) -> tuple[str, ...]:
    """Names of the public members of a protocol.

    Examples
    --------
    >>> from softway.laws.law import StoredEnergy
    >>> asked(StoredEnergy)[:3]
    ('measure', 'linear', 'energy')
    """
    found: dict[str, None] = {}
    for base in reversed(protocol.__mro__):
        if base not in (object, Protocol, Generic):
            found.update(dict.fromkeys((*getattr(base, "__annotations__", {}), *vars(base))))
    return tuple(name for name in found if not name.startswith("_"))


def lacking(subject: Any, protocol: type) -> tuple[str, ...]:
    """Members of a protocol that a class or an object lacks.

    Examples
    --------
    >>> from softway.laws.law import StoredEnergy
    >>> lacking(float, StoredEnergy)[:3]
    ('measure', 'linear', 'energy')
    """
    own = {f.name for f in fields(subject)} if is_dataclass(subject) else set()
    return tuple(name for name in asked(protocol) if name not in own and not hasattr(subject, name))
