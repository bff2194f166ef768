"""Model with stored energies on fixed contact rows as arrays for compiled slabs."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple, cast

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import NodalDofs
from softway.bodies.elements.section import PlaneStrain, Volume
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.slab_average import Weighted
from softway.contact.contact_rows import ContactRows
from softway.kernels.jit.by_address import packed
from softway.kernels.jit.lanes import LANES
from softway.kernels.slab.stored.force import solid_forces
from softway.kernels.slab.stored.tables import Cells, Stored, Turning
from softway.kernels.slab.tables import Bodies, Operator, Rows
from softway.marching.audit.folded_cells import WatchedCells, watched_cells
from softway.marching.rules.equilibrated import EndForceContact, Equilibrated
from softway.marching.slab.compiled_model import answers_of, bodies_of, operator_of, rows_of
from softway.marching.slab.rows.friction import every_row, without_friction
from softway.marching.slab.slab_step import Stepper
from softway.marching.slab.stored.solving_factor import SolvingFactor, way_of
from softway.marching.state.march_state import Settings
from softway.model.model import Model
from softway.model.time_weight import EndPeaks, moments
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.operators.factored import Factored
from softway.solve.operators.nodal_rotation import SMALL, NodalRotation, nodal_rotation
from softway.solve.operators.operator_memory import OperatorOrigin
from softway.solve.operators.operator_refresh import WORTH

SLABS = 1000
"""Number of slabs of a march from which compiled ones pay: the others take less than the compilation of the kernels."""


@dataclass(frozen=True, slots=True, eq=False)
class Tables:
    """Addresses (k,) of tables, which are ``kept`` with their arrays."""

    places: IntArray
    kept: tuple[object, ...]

    @classmethod
    def of(cls, arrays: Iterable[NamedTuple], kept: object = None) -> "Tables":
        """Tables of these arrays, which may contain addresses of others that are ``kept``."""
        arrays = tuple(arrays)
        made = [packed(each) for each in arrays]
        return cls(np.array([each.ctypes.data for each in made], np.int64), (made, arrays, kept))


@dataclass(frozen=True, slots=True, eq=False)
class FrozenFactor:
    """Factor of an operator and the deformation ``gradient`` (n, d, d) at the nodes where it was made.

    ``operators`` keeps that of the last closed rows, ``answers`` the answers (N,) to impulses on rows.
    """

    found: SolvingFactor
    gradient: Array
    operators: dict[bytes, Operator | None] = field(default_factory=dict)
    answers: dict[int, Array] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StoredModel:
    """Arrays of a model with stored energies for slabs of the length ``span`` [s].

    ``solids`` are the tables of the solids, ``factored`` makes factors of operators, ``watched`` are the cells
    whose shapes are looked at, ``turning`` and ``slopes`` the sampling of rotations.  ``factors`` keeps that of the
    last operator; it depends on the place where that was made only.
    """

    model: Model
    method: FixedPoint
    bodies: Bodies
    contact_rows: ContactRows
    rows: Rows
    solids: Tables
    factored: Callable[[sp.csc_array], SolvingFactor | None]
    watched: WatchedCells
    turning: NodalRotation
    slopes: tuple[IntArray, IntArray, Array]
    span: float
    factors: dict[bytes, FrozenFactor | None] = field(default_factory=dict)

    def factor(self, origin: OperatorOrigin) -> FrozenFactor | None:
        """Factor of the operator of an origin; None if it is not positive definite."""
        key = origin.at.tobytes()
        if key not in self.factors:
            self.factors.clear()
            self.factors[key] = self._made(origin)
        return self.factors[key]

    def operator(
        self, origin: OperatorOrigin, closed: BoolArray, mixed: bool
    ) -> tuple[Operator, Turning, SolvingFactor] | None:
        """Operator with the rows ``closed`` (m,), its rotation and its factor; None if there is none.

        Rows are solved for in axes that turn where they are ``mixed``, in every slab anew: with a factor of a library
        this takes longer than the solver for all models.
        """
        factor = self.factor(origin)
        if factor is None or (mixed and closed.any() and factor.found.call is not None):
            return None
        operator = self._closed(factor, closed)
        if operator is None:
            return None
        if mixed:
            answer, inverse = np.zeros_like(operator.answer), np.zeros_like(operator.inverse)
            operator = operator._replace(answer=answer, inverse=inverse)
        return operator, self._turning(factor, len(operator.active), mixed), factor.found

    def _turning(self, factor: FrozenFactor, closed: int, mixed: bool) -> Turning:
        """Rotation of the operator, with room for closed rows."""
        start, node, slope = self.slopes
        constant = not mixed and bool(self.rows.move.any())
        return Turning(
            start=start,
            node=node,
            slope=slope,
            before=factor.gradient,
            inverse=np.ascontiguousarray(np.linalg.inv(factor.gradient)),
            free=np.ascontiguousarray(self.model.dofs.free.all(axis=1)),
            rotation=np.zeros(factor.gradient.shape),
            limit=np.array([WORTH if constant else SMALL]),
            state=np.array([mixed, 0], np.int64),
            compliance=np.zeros((closed, closed)),
            size=np.zeros(closed),
        )

    def _made(self, origin: OperatorOrigin) -> FrozenFactor | None:
        found = self.factored(origin.stiffness(self.model).operator(origin.at))
        return None if found is None else FrozenFactor(found, self.turning.gradient(origin.at))

    def _closed(self, frozen: FrozenFactor, closed: BoolArray) -> Operator | None:
        """Operator of a factor with closed rows (m,); None if these depend on each other."""
        key = closed.tobytes()
        if key not in frozen.operators:
            frozen.operators.clear()
            held, every = without_friction(closed), every_row(self.contact_rows)
            frozen.operators[key] = operator_of(partial(self._answers, frozen), every, frozen.found.factor, held)
        return frozen.operators[key]

    def _answers(self, frozen: FrozenFactor, which: IntArray) -> Array:
        """Answers (k, N) to unit impulses on some rows (k,)."""
        new = np.array([row for row in which.tolist() if row not in frozen.answers], np.int64)
        with frozen.found.limited():
            found = answers_of(self.bodies, self.rows, frozen.found.factor, new)
        frozen.answers.update(zip(new.tolist(), found, strict=True))
        return np.array([frozen.answers[row] for row in which.tolist()]).reshape(len(which), len(self.bodies.heavy))


def stored_model(stepper: Stepper, settings: Settings, span: float) -> StoredModel | None:
    """Arrays of a march with slabs of the length ``span`` [s]; None where it is short, large or not :func:`served`."""
    model, method = stepper.model, stepper.method
    if settings.until < SLABS * span or not served(stepper, settings):
        return None
    assert isinstance(method, FixedPoint)
    factor = 0.5 * span**2 * moments(settings.weight)[1]
    way = way_of(sp.csr_array(model.inertia_and_stiffness(np.zeros(model.shape), factor)))
    bodies = None if way is None else bodies_of(model, way.place)
    if way is None or bodies is None:
        return None
    found, turning = (
        model.contacts.rest(np.zeros(model.shape), 0.0).start(np.zeros(model.shape)),
        nodal_rotation(model.parts),
    )
    rows = rows_of(model, settings, found)
    crushable = np.array([not part.internal.linear for part in model.parts])[rows.part]
    edge = model.edge[found.node]
    return StoredModel(
        model=model,
        method=method,
        bodies=bodies,
        contact_rows=found,
        rows=rows._replace(allowed=np.where(crushable, settings.control.approach * edge, rows.allowed)),
        solids=_stored(model),
        factored=way.factored,
        watched=watched_cells(model),
        turning=turning,
        slopes=_slopes(turning),
        span=span,
    )


def served(stepper: Stepper, settings: Settings) -> bool:
    """True if the slabs of a march may be compiled: stored energies with fused kernels of which one is not linear,
    fixed rows without friction, and steady loads.
    """
    model, rule = stepper.model, stepper.rule
    return (
        isinstance(rule, Equilibrated)
        and isinstance(rule.method, FixedPoint)
        and rule.method.operator in ("auto", Factored())
        and isinstance(rule.contact, EndForceContact)
        and rule.calm == 0.0
        and settings.weight == EndPeaks()
        and settings.tolerance is None
        and not (stepper.ends or model.linear)
        and _steady(model)
        and all(_fused(part) for part in model.parts)
    )


def _steady(model: Model) -> bool:
    """True if nothing but the motion of solids with inertia changes from slab to slab."""
    alone = not (model.companions or model.driven or model.adapted or model.bonds) and model.rigid is None
    plain = isinstance(model.dofs, NodalDofs) and isinstance(model.space, LocalSpace)
    still = model.loads.steady and np.array_equal(model.load, model.load_before) and model.inert
    met = model.contacts.fixed and model.friction.frictionless and model.contacts.clearance is None
    return bool(alone and plain and still and met)


def _fused(part: DiscreteSolid) -> bool:
    """True for solids whose fused kernels take the volume change of each point."""
    force = part.internal
    plain = part.shock is None and part.factor is None and isinstance(part.average, Weighted)
    if not (plain and isinstance(force, ElasticForce) and isinstance(force.section, PlaneStrain | Volume)):
        return False
    return isinstance(force.work, KernelEvaluation) and force.work.mean == 0


def _slopes(turning: NodalRotation) -> tuple[IntArray, IntArray, Array]:
    """Sampling of rotations as rows of one pattern: ``start`` (n + 1,), ``node`` (z,) and ``slope`` (z, d)."""
    together = sp.csr_array(sum(abs(slope) for slope in turning.slopes))
    row = np.repeat(np.arange(together.shape[0]), np.diff(together.indptr))
    values = [np.asarray(slope[row, together.indices]).ravel() for slope in turning.slopes]
    return (
        np.asarray(together.indptr, np.int64),
        np.asarray(together.indices, np.int64),
        np.ascontiguousarray(np.transpose(values)),
    )


def _stored(model: Model) -> Tables:
    """Tables of the solids."""
    solids, kept, forces = list[NamedTuple](), list[object](), solid_forces()
    for part in model.parts:
        work = cast(KernelEvaluation, cast(ElasticForce, part.internal).work)
        cells = Tables.of(_cells(work))
        shape = part.mesh.n_nodes + len(work.cells.extra) + 1, part.mesh.dim
        extra = np.ascontiguousarray(work.cells.extra, np.int64)
        solids.append(
            Stored(
                forces=forces.address,
                cells=cells.places,
                extra=extra,
                u=np.zeros(shape),
                out=np.zeros(shape),
                energy=np.zeros(1),
            )
        )
        kept.append(cells)
    return Tables.of(solids, (kept, forces))


def _cells(work: KernelEvaluation) -> Iterator[Cells]:
    """Cells of each type of a solid."""
    for block in work.cells.blocks:
        yield Cells(
            measure=work.law.measure.address,
            law=work.law.law.address,
            moduli=np.ascontiguousarray(work.law.moduli, float),
            rows=block.rows,
            table=np.ascontiguousarray(block.table),
            geometry=block.geometry,
            starts=np.ascontiguousarray(block.starts, np.int64),
            energy=np.zeros((len(block.rows), LANES)),
        )
