"""Model with linear laws on fixed contact rows as arrays for compiled slabs (docs/theory/solver/compiled_slabs.md)."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.dof_map import NodalDofs
from softway.bodies.elements.section import Axisymmetric
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.slab_average import Weighted
from softway.contact.contact_rows import ContactRows
from softway.kernels.jit.by_address import packed
from softway.kernels.slab.apart import Surfaces
from softway.kernels.slab.march import answer
from softway.kernels.slab.tables import Bodies, Operator, Rows
from softway.marching.rules.equilibrated import EndForceContact, Equilibrated
from softway.marching.slab.band import BandOrder, SlabFactor, band_order, banded_factor
from softway.marching.slab.rows.apart import MetSurfaces, may_stay_apart, met_surfaces, surfaces_of
from softway.marching.slab.rows.driven import supports_move_mass, tools_keep_direction
from softway.marching.slab.rows.friction import HeldRows, every_row, held_rows, proportional
from softway.marching.slab.slab_step import Stepper
from softway.marching.state.march_state import Settings
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import SMALL_STRAIN
from softway.model.model import Model
from softway.model.time_weight import EndPeaks, moments
from softway.solve.equations.energy_balance import body_groups
from softway.solve.methods.fixed_point import FixedPoint

SLABS = 200
"""Number of slabs of a march from which compiled ones pay: the others take less than the compilation of the kernels,
and half a second where these are compiled.
"""
TRANSLATED = 1e-12
"""Force of a translation, relative to the stiffness, that is rounding."""
INVERTED = 1e-6
"""Greatest error of the inverse compliance of the closed rows: rows that depend on each other have none."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabTables:
    """Tables of slabs with the same closed rows, and their contact rows."""

    bodies: Bodies
    rows: Rows
    operator: Operator
    surfaces: Surfaces | None
    contact_rows: ContactRows
    held: HeldRows


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CompiledModel:
    """Arrays of a model for slabs of the length ``span`` [s], or less where these end at the instants ``ends``.

    ``order`` is that of the unknowns in a band; ``surfaces`` are those of solids that may touch each other; ``factors``
    and ``last`` keep the factors of the last length and the tables of the last closed rows, which depend on these only.
    """

    model: Model
    bodies: Bodies
    order: BandOrder
    span: float
    ends: tuple[float, ...]
    tolerance: float
    settings: Settings
    surfaces: Surfaces | None
    factors: dict[float, SlabFactor | None] = field(default_factory=dict)
    last: dict[str, SlabTables | None] = field(default_factory=dict)

    def factor(self, span: float) -> SlabFactor | None:
        """Factor of the operator of slabs of the length ``span`` [s]; None if it is not positive definite."""
        if span not in self.factors:
            self.factors.clear()
            self.factors[span] = banded_factor(_operator(self.model, self.settings, span), self.order)
        return self.factors[span]

    def tables(self, now: ModelState, span: float) -> SlabTables | None:
        """Tables for slabs of the length ``span`` [s] from a state on; None if closed rows depend on each other, rows
        change, or the operator is not positive definite.
        """
        met = met_surfaces(self.model, self.surfaces, now, span)
        if met is None:
            return None
        held = held_rows(self.model, met.rows, now)
        if held is None:
            return None
        key = (held.key + met.rows.near.tobytes() + met.rows.gradient.indices.tobytes()).hex() + span.hex()
        if key not in self.last:
            self.last.clear()
            self.last[key] = self._made(met, held, span)
        return self.last[key]

    def _made(self, met: MetSurfaces, held: HeldRows, span: float) -> SlabTables | None:
        """Tables of rows that are held."""
        found = self.factor(span)
        if found is None:
            return None
        rows = rows_of(self.model, self.settings, met.rows)
        answers_to = partial(answers_of, self.bodies, rows, found)
        operator = operator_of(answers_to, every_row(met.rows), found, held)
        if operator is None:
            return None
        closed = np.isin(np.arange(len(met.rows.node)), held.active)
        return SlabTables(
            bodies=self.bodies._replace(group=_whole(body_groups(self.model, (met.rows, closed)))),
            rows=rows,
            operator=operator,
            surfaces=met.table,
            contact_rows=met.rows,
            held=held,
        )


def operator_of(
    answers_to: Callable[[IntArray], Array], every: sp.csr_array, found: SlabFactor, held: HeldRows
) -> Operator | None:
    """Operator with the rows that are held, of ``every`` row (M, N); None if their forces are not unique.

    ``answers_to`` gives the answers (k, N) to unit impulses on some rows (k,).
    """
    answers = answers_to(held.active)
    slips = answers_to(held.slip)
    for each, partner, ratio in zip(slips, held.partner, held.factor, strict=True):
        answers[held.active == partner] += ratio * each
    compliance = answers @ every[held.active].T
    inverse = np.zeros((len(held.active), len(held.active)))
    if len(held.active):
        if not np.linalg.cond(compliance) * np.finfo(float).eps < INVERTED or not _positive(compliance):
            return None
        inverse = np.linalg.inv(compliance.T)
    return Operator(
        *found,
        active=held.active,
        answer=answers,
        inverse=inverse,
        slip=held.slip,
        partner=held.partner,
        factor=held.factor,
    )


def answers_of(bodies: Bodies, rows: Rows, found: SlabFactor, which: IntArray) -> Array:
    """Answers (k, N) to unit impulses on some rows (k,)."""
    out, work = np.zeros((len(which), len(bodies.heavy))), np.empty(len(found.pivot))
    tables = packed(bodies), packed(rows)
    for row, each in zip(which, out, strict=True):
        answer(*(table.ctypes.data for table in tables), row, *found, work, each)
    return out


def _positive(matrix: Array) -> bool:
    """True if the symmetric part of a matrix (k, k) is positive definite: then no other forces hold the rows."""
    return bool(np.linalg.eigvalsh(matrix + matrix.T).min() > 0.0)


def served(stepper: Stepper, settings: Settings) -> bool:
    """True if the slabs of a march may be compiled: linear laws, fixed rows without friction, and steady loads."""
    model, rule = stepper.model, stepper.rule
    return (
        isinstance(rule, Equilibrated)
        and isinstance(rule.method, FixedPoint)
        and isinstance(rule.contact, EndForceContact)
        and rule.calm == 0.0
        and settings.weight == EndPeaks()
        and settings.tolerance is None
        and _fixed(model)
        and all(_linear(part.internal) and part.shock is None for part in model.parts)
        and all(isinstance(part.average, Weighted) for part in model.parts)
    )


def _fixed(model: Model) -> bool:
    """True if nothing but the motion of solids with inertia changes from slab to slab."""
    alone = not (model.companions or model.adapted) and model.rigid is None and supports_move_mass(model)
    plain = isinstance(model.dofs, NodalDofs) and isinstance(model.space, LocalSpace)
    still = not model.loads.steady or np.array_equal(model.load, model.load_before)
    known = tools_keep_direction(model.contacts) and may_stay_apart(model.contacts)
    met = known and proportional(model) and model.contacts.clearance is None and model.inert
    return bool(alone and plain and still and met and model.linear)


def _linear(force: object) -> bool:
    return isinstance(force, ElasticForce) and force.linear and not isinstance(force.section, Axisymmetric)


def compiled_model(stepper: Stepper, settings: Settings, span: float) -> CompiledModel | None:
    """Arrays of a march with slabs of the length ``span`` [s]; None where it is short, large or not :func:`served`."""
    model = stepper.model
    if settings.until < SLABS * span or not served(stepper, settings):
        return None
    order = band_order(_operator(model, settings, span))
    if order is None:
        return None
    bodies = bodies_of(model, order.place)
    if bodies is None:
        return None
    assert isinstance(stepper.method, FixedPoint)
    compiled = CompiledModel(
        model=model,
        bodies=bodies,
        order=order,
        span=span,
        ends=stepper.ends,
        tolerance=stepper.method.tolerance,
        settings=settings,
        surfaces=surfaces_of(model.contacts),
    )
    return None if compiled.factor(span) is None else compiled


def _operator(model: Model, settings: Settings, span: float) -> sp.csr_array:
    """Operator (f, f) of slabs of the length ``span`` [s]."""
    return sp.csr_array(model.inertia_and_stiffness(np.zeros(model.shape), 0.5 * span**2 * moments(settings.weight)[1]))


def bodies_of(model: Model, place: IntArray) -> Bodies | None:
    """Arrays of the solids; ``place`` (f,) are the places of the unknowns in the band.

    None where translations cause forces.
    """
    (n, d), own = model.shape, np.full(model.free.size, -1)
    own[model.dofs.components] = place
    mass, stiff = (
        sp.csr_array(model.mass),
        sp.bsr_array(sp.csr_array(model.tangent(np.zeros((n, d)))), blocksize=(d, d)),
    )
    node = np.repeat(np.arange(n), np.diff(stiff.indptr))
    sums, sizes = np.zeros((n, d, d)), np.zeros(n)
    np.add.at(sums, node, stiff.data)
    np.maximum.at(sizes, node, np.abs(stiff.data).max(axis=(1, 2)))
    if (np.abs(sums).max(axis=(1, 2)) > TRANSLATED * sizes).any():
        return None
    others = stiff.indices != node
    return Bodies(
        dimension=d,
        first=_whole([p.nodes.start for p in model.parts] + [n]),
        group=_whole(model.linked),
        heavy=np.repeat(model.massive, d),
        place=_whole(own),
        mass_start=_whole(mass.indptr),
        mass_node=_whole(mass.indices),
        mass=mass.data.astype(float),
        weight=np.asarray(mass.sum(axis=1)).ravel(),
        stiff_start=_whole(np.concatenate([[0], np.cumsum(np.bincount(node[others], minlength=n))])),
        stiff_node=_whole(stiff.indices[others]),
        stiff=np.ascontiguousarray(stiff.data[others]),
        points=np.ascontiguousarray(model.points, float).ravel(),
        load=np.array(model.load, float).ravel(),
        load_before=np.array(model.load_before, float).ravel(),
        given=np.zeros(n * d),
        bent=np.zeros(n * d),
        floor=np.asarray(model.floor, float),
    )


def rows_of(model: Model, settings: Settings, rows: ContactRows) -> Rows:
    """Arrays of contact rows."""
    every, m = every_row(rows), len(rows.node)
    offset = np.concatenate([rows.offset, np.zeros(every.shape[0] - m)])
    return Rows(
        normals=m,
        start=_whole(every.indptr),
        component=_whole(every.indices),
        value=every.data.astype(float),
        before=offset.copy(),
        offset=offset,
        moved=np.zeros(len(offset)),
        contact=_whole(rows.contact),
        part=_whole(model.part_of[rows.node]),
        move=rows.reachable(model.dofs),
        allowed=max(settings.control.approach, SMALL_STRAIN) * model.edge[rows.node],
    )


def _whole(values: object) -> IntArray:
    """Integers of one kind, so that kernels are compiled once."""
    return np.ascontiguousarray(values, dtype=np.int64)
