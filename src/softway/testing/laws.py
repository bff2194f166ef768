"""Examination of a law: which examinations there are for its kind, and all of them at once."""

from typing import Any

from softway.laws.fitting import asked, lacking
from softway.laws.friction_law import FrictionLaw
from softway.laws.law import RateLaw, StoredEnergy
from softway.testing.described import DESCRIBED
from softway.testing.examination import Examination, Finding, findings, require_all
from softway.testing.friction import FRICTION_LAW
from softway.testing.rate_law import RATE_LAW
from softway.testing.stored_energy import STORED_ENERGY

KINDS: tuple[tuple[type, tuple[Examination, ...]], ...] = (
    (StoredEnergy, STORED_ENERGY),
    (RateLaw, RATE_LAW),
    (FrictionLaw, FRICTION_LAW),
)
"""Protocols of laws with their examinations; a law belongs to the first whose members it has."""


def check_law(law: Any) -> None:
    """Raise ``AssertionError`` saying what is wrong with a law; return quietly if nothing is.

    For a stored energy: shapes, the undeformed state, stress as derivative of the energy, moduli as derivative of the
    stress, their symmetries, the energy of tiny strains against the work of the stress, indifference to rotations,
    inverted matter, and the moduli of small strains that the law reports.  For a law with a history, along paths of
    several sizes and speeds: shapes, symmetries, moduli as derivative of the stress, elastic moduli, dissipation, the
    energies against the work of the stress, rest, and turns of the body through its points.  For a law of friction:
    that it opposes slip and holds what rests, and its derivatives.  For every law: units of its parameters, and its
    text in a scenario.

    Examples
    --------
    >>> from softway.laws.bulk import NeoHookean
    >>> check_law(NeoHookean(E=1.0, nu=0.3))
    """
    require_all(law, examinations(law))


def examine_law(law: Any) -> tuple[Finding, ...]:
    """What each examination found, with its worst error; never raises for what the law does.

    Examples
    --------
    >>> from softway.laws.bulk import NeoHookean
    >>> all(finding.passed for finding in examine_law(NeoHookean(E=1.0, nu=0.3)))
    True
    """
    return findings(law, examinations(law))


def examinations(law: Any) -> tuple[Examination, ...]:
    """The examinations for a law of its kind.

    Raises
    ------
    AssertionError
        It has the members of no kind of law.
    """
    for protocol, those in KINDS:
        if not lacking(law, protocol):
            return (*those, *DESCRIBED)
    least = min((p for p, _ in KINDS), key=lambda p: len(lacking(law, p)) / len(asked(p)))
    raise AssertionError(f"{law} is no law: for a {least.__name__} it lacks {', '.join(lacking(law, least))}")
