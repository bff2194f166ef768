"""Accepted slab (time step): the state before and after, its audit, and its events."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import nan

import numpy as np

from softway.adaptivity.transfer import Transferred
from softway.arrays import Array
from softway.heat.coupled.heat_of_solids import HeatOfSolids
from softway.html_tables import table
from softway.marching.results.exchange import Exchange
from softway.marching.results.step_states import StepStates
from softway.marching.state.march_state import MarchState
from softway.model.model import Model
from softway.model.scene import State
from softway.model.slab import Slab


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Event inside a slab: touch, release, start of sticking or slip of a contact node, break of a tie, or a finding.

    Parameters
    ----------
    time
        Instant inside the slab [s].
    contact, kind, node
        Contact label; ``touch``, ``release``, ``stick`` or ``slip``; node number in its body. A tie has its label and
        the kind ``break``, a finding the names of the bodies and a kind of ``marching.results.finding.KINDS``.
    position
        (d,) position of the node [m].
    velocity_before, velocity_after
        Normal velocity before and after the instant, negative towards the obstacle; for ``stick`` and ``slip`` the slip
        speed, for ``break`` the mean speed of the opening in the slab [m/s].
    impulse
        Normal impulse of the velocity jump [N s]; zero at a release.
    depth
        Depth of an overlap that the audit found [m].
    finding
        Sentence of the audit; empty for a contact event.
    bodies
        Names of the two that touch, the one with the node first, or of one twice; empty for other events.
    """

    time: float
    contact: str
    kind: str
    node: int
    position: Array
    velocity_before: float
    velocity_after: float
    impulse: float
    depth: float = 0.0
    finding: str = ""
    bodies: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactLedger:
    """Audit of one contact over one slab.

    Parameters
    ----------
    force_n, force_t
        Resultant normal and tangential force over the slab (impulse / h) [N].
    min_gap, count
        Least gap at the end [m], and number of contact nodes in contact there.
    power_residual
        Sum of F_n v_n dt, eq. (3.9) [J].
    """

    force_n: float
    force_t: float
    min_gap: float
    power_residual: float
    count: int


@dataclass(frozen=True, slots=True, kw_only=True)
class TieLedger:
    """Audit of one tie that breaks.

    Parameters
    ----------
    broken
        Fraction of its area without force.
    opening
        Greatest jump of a node over the tie, in any direction [m].
    dissipated
        Energy dissipated since the start of the march [J].
    """

    broken: float
    opening: float
    dissipated: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Ledger:
    """Energies and momenta at the end of a slab, and works since the start of the march.

    Parameters
    ----------
    energy_kinetic, energy_strain
        At the end [J].
    work_external, dissipation
        Since the start: work of loads, supports and moving tools; energy dissipated by friction and material,
        with ``heat.reversible`` in solids with a temperature [J].
    energy_error
        ``kinetic + strain - initial - work_external + dissipation + remeshing`` [J].
    momentum
        (3,) [kg m/s].
    spin
        (3,) angular momentum about the origin [kg m^2/s].
    contacts
        Contact label -> its audit over the slab.
    ties
        Label of a tie that breaks -> its audit.
    heat
        Heat of the solids with a temperature; None without.
    remeshing
        Energy that changes of the mesh have taken since the start; zero where none has changed [J].
    """

    energy_kinetic: float
    energy_strain: float
    work_external: float
    dissipation: float
    energy_error: float
    momentum: Array
    spin: Array
    contacts: Mapping[str, ContactLedger]
    ties: Mapping[str, TieLedger] = field(default_factory=dict)
    heat: HeatOfSolids | None = None
    remeshing: float = 0.0

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        joules: tuple[str, ...] = ("energy_kinetic", "energy_strain", "work_external", "dissipation", "energy_error")
        joules += ("remeshing",) if self.remeshing else ()
        rows = {name.replace("_", " "): f"{getattr(self, name):.4g} J" for name in joules}
        rows["momentum"] = f"{np.array2string(self.momentum, precision=4)} kg m/s"
        rows |= {f"contact {name}": _contact(found) for name, found in self.contacts.items()}
        rows |= {f"tie {name}": _tie(found) for name, found in self.ties.items()}
        return table("Ledger", rows)


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """Residuals of the contact conditions and the balances of a slab.

    Parameters
    ----------
    min_gap
        Least gap of the contact rows at the end [m]: of nodes, and for mortar contact the weighted mean around nodes.
    min_force
        Least normal force at the end [N].
    complementarity
        Sum of force times gap at the end [J].
    power_residual
        Sum of F_n v_n dt over the slab, eq. (3.9) [J].
    momentum_error, energy_error
        Errors of the balances of this slab [kg m/s], [J].
    gap_nodes, gap_between
        Minus the deepest overlap of all surfaces at nodes and between them, from the geometry at the end [m]; not a
        number in slabs that were not audited.
    shape
        Least scaled Jacobian of the cells at the end: zero or less where one has folded; not a number without solids of
        large strain.
    """

    min_gap: float
    min_force: float
    complementarity: float
    power_residual: float
    momentum_error: float
    energy_error: float
    gap_nodes: float = nan
    gap_between: float = nan
    shape: float = nan

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        units = ("m", "N", "J", "J", "kg m/s", "J", "m", "m", "")
        numbers = zip(fields(self), units, strict=True)
        return table("Certificate", {f.name.replace("_", " "): f"{getattr(self, f.name):.3g} {u}" for f, u in numbers})


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Report on the solution of a slab.

    Parameters
    ----------
    iterations
        Number of iterations of this slab.
    pairs
        Number of pairs of nodes, facets or edges that the search found.
    factorisations, renewals
        Factorisations since the start of the march; those that renewed the operator of the fixed point inside a slab.
    passes
        Number of solutions of the slab with different contact events.
    contraction
        Mean ratio of successive changes of the iterates.
    rejections
        Reasons of rejected attempts.
    scalars
        Scalar of the Energy rule for each body.
    """

    iterations: int
    pairs: int
    factorisations: int
    passes: int
    contraction: float = 0.0
    rejections: tuple[str, ...] = ()
    scalars: Mapping[str, float] | None = None
    renewals: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """Accepted slab.

    Parameters
    ----------
    model
        Model on the meshes of the slab.
    slab
        Time interval of the slab.
    ledger
        Energies, works and momenta.
    certificate
        Residuals of the contact conditions and the balances.
    events
        Contact events inside the slab, in order.
    report
        Iterations, rejections and other data on the solution.
    states
        States at both ends, and forces of the supports; after compiled slabs they are made when they are asked for.
    transfers, exchanges
        What has changed before the slab, by name: adapted meshes, and those of solids with ``remesh``.
    """

    model: Model = field(repr=False)
    slab: Slab
    ledger: Ledger
    certificate: Certificate
    events: tuple[Event, ...]
    report: Report
    states: StepStates = field(repr=False)
    transfers: Mapping[str, Transferred] = field(default_factory=dict, repr=False)
    exchanges: Mapping[str, Exchange] = field(default_factory=dict, repr=False)

    @property
    def before(self) -> State:
        """State at the start; displacements are those from ``model.points``, the reference of these meshes."""
        return self.states.before

    @property
    def after(self) -> State:
        """State at the end."""
        return self.states.after

    @property
    def reactions(self) -> Mapping[str, Array]:
        """Body -> (n, d) mean force of the supports on the nodes [N]."""
        return self.states.reactions

    @property
    def march_state(self) -> MarchState:
        """State of the march after the slab, from which another march continues with the same bits."""
        return self.states.march_state

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
    """Description of a contact for notebooks."""
    return f"{found.count} nodes in contact, {found.force_n:.4g} N, least gap {found.min_gap:.3g} m"


def _tie(found: TieLedger) -> str:
    """Description of a tie for notebooks."""
    return f"{100.0 * found.broken:.3g} % broken, {found.dissipated:.4g} J dissipated, opening {found.opening:.3g} m"
