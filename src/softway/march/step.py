"""One accepted slab: the situation before and after, its audit, and what happened inside."""

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from softway.march.standing import Standing
from softway.markup import table
from softway.scene import State
from softway.time.slab import Slab
from softway.typing import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """A contact node that touched or let go inside a slab, came to rest on its opponent or began to slip.

    Parameters
    ----------
    time
        Instant located inside the slab [s].
    contact, kind, node
        Contact label; ``touch``, ``release``, ``stick`` or ``slip``; node number in its body.
    position
        (d,) where it happened [m].
    velocity_before, velocity_after
        Normal velocity on both sides of the instant, negative towards the obstacle; of ``stick`` and ``slip`` the speed
        along it [m/s].
    impulse
        Normal impulse of the velocity jump [N s]; zero at a release.
    """

    time: float
    contact: str
    kind: str
    node: int
    position: Array
    velocity_before: float
    velocity_after: float
    impulse: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactLedger:
    """Audit of one contact over one slab.

    Parameters
    ----------
    force_n, force_t
        Resultant normal and tangential force over the slab (impulse / h) [N].
    min_gap
        Least gap at the end [m].
    power_residual
        Sum of F_n v_n dt, eq. (3.9) [J].
    count
        Closed nodes at the end.
    """

    force_n: float
    force_t: float
    min_gap: float
    power_residual: float
    count: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Ledger:
    """Energies and momenta at the end of a slab, works from the start of the march on.

    Parameters
    ----------
    energy_kinetic, energy_strain
        At the end [J].
    work_external, dissipation
        From the start on: of loads, supports and moving tools; by friction and matter [J].
    energy_error
        ``kinetic + strain - initial - work_external + dissipation`` [J].
    momentum
        (3,) [kg m/s].
    spin
        (3,) angular momentum about the origin [kg m^2/s].
    contacts
        Contact label -> its audit over the slab.
    """

    energy_kinetic: float
    energy_strain: float
    work_external: float
    dissipation: float
    energy_error: float
    momentum: Array
    spin: Array
    contacts: Mapping[str, ContactLedger]

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        joules = ("energy_kinetic", "energy_strain", "work_external", "dissipation", "energy_error")
        rows = {name.replace("_", " "): f"{getattr(self, name):.4g} J" for name in joules}
        rows["momentum"] = f"{np.array2string(self.momentum, precision=4)} kg m/s"
        rows |= {f"contact {name}": _contact(found) for name, found in self.contacts.items()}
        return table("Ledger", rows)


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """What a slab leaves over of the contact conditions and the balances.

    Parameters
    ----------
    min_gap
        Least gap at the end [m].
    min_force
        Least normal force there [N].
    complementarity
        Sum of force times gap there [J].
    power_residual
        Sum of F_n v_n dt over the slab, eq. (3.9) [J].
    momentum_error, energy_error
        What the balances of this slab miss [kg m/s], [J].
    """

    min_gap: float
    min_force: float
    complementarity: float
    power_residual: float
    momentum_error: float
    energy_error: float

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        units = ("m", "N", "J", "J", "kg m/s", "J")
        numbers = zip(fields(self), units, strict=True)
        return table("Certificate", {f.name.replace("_", " "): f"{getattr(self, f.name):.3g} {u}" for f, u in numbers})


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """How the solution was found.

    Parameters
    ----------
    iterations
        Of this slab.
    pairs
        Of nodes, facets or edges that the search found.
    factorisations
        Since the start of the march.
    passes
        Over the contact events.
    contraction
        Mean factor by which the changes of the iterations fell.
    rejections
        Reasons of the tries that were dropped.
    scalars
        The scalar of the Energy rule for each body.
    """

    iterations: int
    pairs: int
    factorisations: int
    passes: int
    contraction: float = 0.0
    rejections: tuple[str, ...] = ()
    scalars: Mapping[str, float] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """An accepted slab.

    Parameters
    ----------
    before, after
        The situation at both ends.
    slab
        Its interval of time.
    ledger
        Energies, works and momenta.
    certificate
        What it leaves over of the contact conditions and the balances.
    events
        Touches and releases inside, in their order.
    reactions
        Body -> (n, d) mean force of the supports on the nodes [N].
    report
        How the solution was found.
    standing
        Where the march stands after it, from which another march goes on with the same bits.
    """

    before: State
    after: State
    slab: Slab
    ledger: Ledger
    certificate: Certificate
    events: tuple[Event, ...]
    reactions: Mapping[str, Array]
    report: Report
    standing: Standing

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        ledger = self.ledger
        rows = {
            "iterations": self.report.iterations,
            "kinetic, strain energy": f"{ledger.energy_kinetic:.4g} J, {ledger.energy_strain:.4g} J",
            "energy error": f"{ledger.energy_error:.2g} J",
            **{f"contact {name}": _contact(found) for name, found in ledger.contacts.items()},
            "events": "\n".join(f"{e.kind} of node {e.node} ({e.contact}) at {e.time:.6g} s" for e in self.events[:8]),
        }
        more = f"\nand {len(self.events) - 8} more" if len(self.events) > 8 else ""
        rows["events"] = f"{rows['events']}{more}" or "none"
        return table(f"Slab from {self.slab.start:.6g} s to {self.slab.end:.6g} s", rows)


def _contact(found: ContactLedger) -> str:
    """A contact in words."""
    return f"{found.count} nodes closed, {found.force_n:.4g} N, least gap {found.min_gap:.3g} m"
