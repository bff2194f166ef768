"""Missing work of the energy balance of a slab (time step), which the scalar closes, and its rounding errors."""

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.assembled.following_nodes import reactions
from softway.bodies.assembled.vector_space import LocalSpace
from softway.contact.contact_rows import ContactRows
from softway.kernels.slab.works import (
    ENDS,
    ENDS_SLOPE,
    LOADED,
    MOVING,
    SIZE,
    SLOPE,
    STILL,
    STILL_SLOPE,
    WORKS,
    works,
)
from softway.model.model import Model
from softway.solve.equations.end_forces import EndForces


def moving_part(model: Model, ends: EndForces) -> Array:
    """Motion (n, d) of the components with inertia [m]."""
    return np.asarray((ends.u1 - ends.u0) * model.massive[:, None])


def missing_work(model: Model, ends: EndForces, touched: BoolArray) -> tuple[Array, Array, Array, Array]:
    """Missing work, its derivative with respect to the scalar a, the rounding level, and the magnitude of the work of
    the mean force (parts,).

    Linear solids that nothing touches, ``touched`` (parts,) False, are balanced by internal forces alone.  Others are
    not: there the residual of massless nodes is an error of the iterate, which the balance has to see.
    """
    (done, kinetic), change = _works(model, ends), ends.V1 - ends.V0
    slave, n = model.part_of[ends.rows0.node], len(model.parts)
    with np.errstate(invalid="ignore"):
        d0 = np.where(ends.force0 > 0.0, ends.force0 * ends.rows0.tool_motion, 0.0)
        d1 = np.where(ends.force1 > 0.0, ends.force1 * ends.rows1.tool_motion, 0.0)
    num = change - done[MOVING] - done[STILL] - np.bincount(slave, weights=0.5 * (d0 + d1), minlength=n)
    den = done[SLOPE] + np.bincount(slave, weights=d1 - d0, minlength=n) + done[STILL_SLOPE]
    rough = bool(ends.rows0.shear.count) or ends.viscous is not None
    if not rough and model.driven:
        loads, du = (model.load_before, model.load), ends.u1 - ends.u0
        r0, r1 = (_support_forces(model, f - q, rows, p) for (f, rows, p), q in zip(ends.both, loads, strict=True))
        num = num - model.space.totals(0.5 * (r0 + r1) * du)
        den = den + model.space.totals((r1 - r0) * du)
    flying = ~touched & model.linear
    if rough or flying.any():
        inner = change - done[MOVING] - done[ENDS], done[ENDS_SLOPE]
        gaps = _closings(model, ends)
        inner = inner[0] + 0.5 * (gaps[0] + gaps[1]), inner[1] - (gaps[1] - gaps[0])
        num, den = (np.where(flying | rough, b, a) for a, b in zip((num, den), inner, strict=True))
    level = np.abs(ends.V1) + np.abs(ends.V0) + kinetic + ends.cancelled + done[SIZE] + done[LOADED]
    level += np.bincount(slave, weights=np.abs(d0) + np.abs(d1), minlength=n)
    return num, den, level, done[SIZE]


def _works(model: Model, ends: EndForces) -> tuple[Array, Array]:
    """Works (WORKS, parts) of the forces of a slab, see :mod:`softway.kernels.slab.works`, and the kinetic energy
    (parts,) at its start [J].
    """
    if isinstance(model.space, LocalSpace):
        out, nodes = np.empty((len(model.parts), WORKS)), [s.start for s in model.space.solids]
        fields = (model.load_before, model.load, ends.u0, ends.u1, ends.f0, ends.f1, ends.mean)
        l0, l1, u0, u1, f0, f1, mean = (np.require(f, float, ["C", "W"]).ravel() for f in fields)  # one kind of array
        first, heavy = np.array([*nodes, len(model.massive)]), np.repeat(model.massive, model.shape[1])
        works(first, model.shape[1], heavy, (l0, l1), u0, u1, (f0, f1), mean, out)
        return out.T, model.kinetic(ends.v0)
    du, moving = ends.u1 - ends.u0, moving_part(model, ends)
    still, change = du - moving, ends.f1 - ends.f0
    found = model.space.totals_of(
        (
            ends.mean * moving,
            np.abs(ends.mean * moving),
            change * moving,
            0.5 * (model.load_before + model.load) * still,
            (model.load - model.load_before) * still,
            np.abs(model.load * du),
            0.5 * (ends.f0 + ends.f1) * still,
            change * du,
            ends.v0 * (model.mass @ ends.v0),
        )
    )
    return found[:WORKS], 0.5 * found[WORKS]


def _closings(model: Model, ends: EndForces) -> tuple[Array, Array]:
    """Work (parts,) of the normal forces at both ends in closing or opening a gap.

    With friction or viscosity, or in flight, the missing work is that of internal forces: at both ends those of
    massless nodes balance loads, contact and supports.  They contain all forces that do work there, including friction;
    only the work of normal forces in closing or opening a gap is excluded.  The numerator then vanishes up to rounding
    if a linear body flies or stays in contact, sticking or slipping.  The other form has the work of the residual of
    the massless nodes over their way, which is rounding on a body that flies far; iterates swing with it, also where
    viscous stresses make it grow.
    """
    du, slave, n = ends.u1 - ends.u0, model.part_of[ends.rows0.node], len(model.parts)
    gaps = []
    for rows, force in ((ends.rows0, ends.force0), (ends.rows1, ends.force1)):
        if not (force > 0.0).any():
            gaps.append(np.zeros(n))
            continue
        with np.errstate(invalid="ignore"):
            change = np.where(force > 0.0, force * (rows.normal_component(du) - rows.tool_motion), 0.0)
        gaps.append(np.asarray(np.bincount(slave, weights=change, minlength=n)))
    return gaps[0], gaps[1]


def blurred_work(model: Model, ends: EndForces) -> Array:
    """Rounding error (parts,) of the energy balance: work of the contact forces over the rounding of positions [J]."""
    extent = model.extent(ends.u1)
    slave = model.part_of[ends.rows0.node]
    force = np.bincount(slave, weights=np.abs(ends.force0) + np.abs(ends.force1), minlength=len(model.parts))
    return np.asarray(4.0 * np.finfo(float).eps * extent * force)


def _support_forces(model: Model, force: Array, rows: ContactRows, push: Array) -> Array:
    """Forces (n, d) of supports on massless components; ``force`` (n, d) are internal forces less loads."""
    out = force - rows.spread(push, model.shape)
    return np.where(model.massive[:, None], 0.0, reactions(model.dofs, out))
