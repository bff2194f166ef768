"""Checks of a law: the examinations for each kind of law, run together."""

from typing import Any

from softway.laws.friction_law import FrictionLaw
from softway.laws.law import RateLaw, StoredEnergy
from softway.scenario.text.conformance import asked, lacking
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
"""Protocols of laws with their examinations; the first protocol that a law satisfies is used."""


def check_law(law: Any) -> None:
    """Check a law; raise ``AssertionError`` with the first error found.

    Stored energy: shapes, undeformed state, stress as derivative of the energy, moduli as derivative of the stress,
    their symmetries, energy of tiny strains against the work of the stress, objectivity under rotations, inverted
    material, and the reported moduli at small strain.

    Path-dependent law, along paths of several sizes and rates: shapes, symmetries, moduli as derivative of the stress,
    elastic moduli, dissipation, energies against the work of the stress, rest, and rotations of the body.

    Friction law: friction opposes slip, the limit at rest is at least the resistance to slip, and the derivatives.

    Every law: units of its parameters, and its text in a scenario.

    Examples
    --------
    >>> from softway.laws.bulk import NeoHookean
    >>> check_law(NeoHookean(E=1.0, nu=0.3))
    """
    require_all(law, examinations(law))


def examine_law(law: Any) -> tuple[Finding, ...]:
    """Result of each examination with its largest error; an error of the law is reported, not raised.

    Examples
    --------
    >>> from softway.laws.bulk import NeoHookean
    >>> all(finding.passed for finding in examine_law(NeoHookean(E=1.0, nu=0.3)))
    True
    """
    return findings(law, examinations(law))


def examinations(law: Any) -> tuple[Examination, ...]:
    """Examinations for the kind of a law.

    Raises
    ------
    AssertionError
        If the law does not have all members of any kind of law.
    """
    for protocol, those in KINDS:
        if not lacking(law, protocol):
            return (*those, *DESCRIBED)
    least = min((p for p, _ in KINDS), key=lambda p: len(lacking(law, p)) / len(asked(p)))
    raise AssertionError(f"{law} is not a law: for a {least.__name__} it lacks {', '.join(lacking(law, least))}")
