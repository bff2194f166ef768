"""March state: all data that the next slab (time step) needs besides the model."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from softway.errors import InputError
from softway.heat.coupled.heat_of_solids import HeatOfSolids
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import StepControl
from softway.meshes.adaptive.leaves import Leaves
from softway.meshes.remeshed.remesh import Quality
from softway.meshes.remeshed.remeshed_mesh import RemeshedMesh
from softway.model.model import Model
from softway.model.time_weight import TimeWeight
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """Settings of a march, see :func:`softway.marching.march.march`."""

    until: float
    step: float | Literal["auto"]
    weight: TimeWeight
    method: FixedPoint | Newton | Explicit
    control: StepControl
    tolerance: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class EnergyAccount:
    """Energy account: energy at the start, and since then external work, dissipation, error of the energy balance,
    energy dissipated by each tie that breaks [J], the heat of the solids, and the energy that changes of the mesh took.
    """

    energy_start: float
    work_external: float = 0.0
    dissipation: float = 0.0
    energy_error: float = 0.0
    ties: tuple[float, ...] = ()
    heat: HeatOfSolids | None = None
    remeshing: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class StepHistory:
    """Step history of a march.

    Parameters
    ----------
    span, length
        Requested slab length, and proposed length of the next slab [s].
    energy_along_motion
        True if the energy balance of the next slab is closed along the motion from the first attempt.
    halted
        True if the last slab ended where a body came to rest.
    dashpots
        True if massless nodes had no equilibrium in the last slab, and dashpots acted on them.
    recent_rejections
        Number of recent rejections in slabs far below the requested length, and of such slabs without end in sight.
    last_rejection
        Reason of the last rejection.
    rejected
        Number of rejected attempts at the last slab.
    smooth
        Number of successive slabs of this length with a small error, under a tolerance.
    fastest
        Greatest velocity of a node so far, at least one that strains by no more than rounding, under a tolerance [m/s].
    """

    span: float
    length: float
    energy_along_motion: bool = False
    halted: bool = False
    dashpots: bool = False
    recent_rejections: float = 0.0
    last_rejection: str = ""
    rejected: int = 0
    smooth: int = 0
    fastest: float = 0.0

    @property
    def altered(self) -> bool:
        """True if the next slab is damped after what happened in the last one."""
        return self.halted or self.dashpots

    @property
    def longest(self) -> float:
        """The longer one of the requested slab length and that of the next slab, which is longer on a ladder [s]."""
        return max(self.span, self.length)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AdaptedMeshes:
    """Meshes of a march that adapt: the leaves of each solid by name, and the greatest energy so far [J]; the number of
    slabs at the last change from which the slab after it may go back, and of changes in a row that were ``refused``
    because massless nodes found no equilibrium.
    """

    leaves: Mapping[str, Leaves]
    energy: float
    changed: int = 0
    refused: int = 0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RemeshedMeshes:
    """Meshes of a march that replaces them, of each such solid by name.

    Parameters
    ----------
    meshes
        The meshes.
    changed
        Number of slabs at the last change.
    failed
        Quality of the worst cells of the solids for which no new mesh was found, at that time.
    rescued
        Time of the last change for a slab that failed at every length [s]; None without one.
    """

    meshes: Mapping[str, RemeshedMesh] = field(repr=False)
    changed: int = 0
    failed: Mapping[str, Quality] = field(default_factory=dict)
    rescued: float | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MarchState:
    """State of a march after a slab.

    With it as ``state``, :func:`~softway.marching.march.march` continues with the same bits: in this process or,
    stored, in another process on the same machine with the same number of threads.

    Parameters
    ----------
    settings
        Settings of the march; with other settings the step history and the operator start anew.
    state
        Displacement, velocity, forces and history variables.
    account, step_history
        Energy account and step history.
    memory
        Origin and statistics of the operator.
    slabs
        Number of slabs accepted with these settings.
    adapted
        Meshes of the state, where meshes adapt.
    remeshed
        Meshes of the state, where they are replaced.
    """

    settings: Settings
    state: ModelState
    account: EnergyAccount
    step_history: StepHistory
    memory: OperatorMemory = OperatorMemory()
    slabs: int = 0
    adapted: AdaptedMeshes | None = None
    remeshed: RemeshedMeshes | None = None

    def asked(self, settings: Settings, history: StepHistory, memory: OperatorMemory) -> "MarchState":
        """Initial march state for other ``settings``, with a new ``history`` and an empty ``memory``."""
        adapted = None if self.adapted is None else replace(self.adapted, changed=0)
        remeshed = None if self.remeshed is None else replace(self.remeshed, changed=0)
        new = replace(self, settings=settings, step_history=history, memory=memory, slabs=0)
        return replace(new, adapted=adapted, remeshed=remeshed)

    @property
    def meshes_changed(self) -> bool:
        """True if the meshes have changed since the last slab, and the old ones are still to be had."""
        return self.adapted is not None and 0 < self.adapted.changed == self.slabs

    def fitting(self, model: Model) -> "MarchState":
        """Check that the state belongs to this model, and return it.

        Raises
        ------
        InputError
            If it belongs to another scene.
        """
        ours, rows = model.shape, len(model.contacts.node)
        start, closed = self.state.start, self.state.closed
        pasts = [m is not None for m in start.states]
        complete = len(pasts) in (0, len(model.parts))
        fitting = len(start.fields) == len(model.companions)
        kinds = ("adapted", self.adapted, model.adapted), ("remeshed", self.remeshed, model.remeshed)
        for kind, mine, others in kinds:
            if (mine is None) == bool(others):
                problem, remedy = ("without", "with") if mine is None else ("with", "without")
                raise InputError("state", f"{problem} {kind} meshes", f"a state {remedy} {kind} meshes")
        if start.displacement.shape != ours or len(closed) != rows or not complete or not fitting:
            found = f"{start.displacement.shape} nodal values and {len(closed)} contact rows"
            raise InputError("state", f"of another scene: {found}", f"one of {ours} and {rows}")
        return self
