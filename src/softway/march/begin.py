"""The first situation of a march: as described, in static equilibrium, and with massless nodes relaxed."""

import logging

import numpy as np

from softway.bodies.loads import Gravity, Traction, traction_force
from softway.contact.timing import Energy
from softway.errors import InputError
from softway.march.situation import Situation
from softway.model import Model
from softway.scene import StaticStart
from softway.solve.equilibrium import equilibrium
from softway.solve.system import Start
from softway.typing import Array

log = logging.getLogger("softway")


def begin(model: Model) -> Situation:
    """The situation at t = 0.

    Raises
    ------
    InputError
        If a body overlaps an obstacle (named with the depth), or a static start leaves rigid motions free.
    """
    u = model.displacement
    _require_apart(model, u)
    start = model.scene.start
    if isinstance(start, StaticStart):
        require_supported(model)
        u, _ = equilibrium(model, u, model.free, _static_load(model, start))
    pressure = np.zeros(len(model.candidates.node))
    if isinstance(model.timing, Energy) and not model.massive.all():
        before = float(model.energy_and_force(u)[0].sum())
        u, pressure = equilibrium(model, u, model.free & ~model.massive[:, None], model.load)
        after = float(model.energy_and_force(u)[0].sum())
        log.info("relaxing the contact nodes at the start releases %.3g J of %.3g J", before - after, before)
    energy, force = model.energy_and_force(u)
    return Situation(
        time=0.0,
        start=Start(displacement=u, velocity=model.velocity, force=force, energy=energy),
        acceleration=np.zeros(model.shape),
        closed=pressure > 0.0,
        pressure=pressure,
    )


def _static_load(model: Model, start: StaticStart) -> Array:
    load = np.zeros(model.shape)
    for k, item in enumerate(start.loads):
        match item:
            case Gravity():
                load += np.asarray(model.mass.sum(axis=1)).reshape(-1, 1) * np.atleast_1d(item.acceleration)
            case Traction():
                body, _, tag = item.on.partition(".")
                part = next((p for p in model.parts if p.name == body), None)
                if part is None:
                    raise InputError(f"start.loads[{k}].on", f"no solid '{body}'", f"one of {[p.name for p in model.parts]}")
                load[part.rows] += traction_force(part.mesh, part.internal.section, tag, item.value)
    return load


def require_supported(model: Model) -> None:
    """Refuse a static start of a body whose supports leave a rigid motion free."""
    for part in model.parts:
        d = part.mesh.dim
        x = part.mesh.points - part.mesh.points.mean(axis=0)
        names = [f"translation along {a}" for a in "xyz"[:d]]
        modes = [np.tile(np.eye(d)[k], (len(x), 1)) for k in range(d)]
        for i, j in ((0, 1), (0, 2), (1, 2)):
            if j < d:
                turn = np.zeros_like(x)
                turn[:, i], turn[:, j] = -x[:, j], x[:, i]
                modes.append(turn)
                names.append(f"rotation in the {'xyz'[i]}{'xyz'[j]} plane")
        held = ~model.free[part.rows]
        constrained = np.array([m[held] for m in modes])
        full = np.array([m.ravel() for m in modes])
        rank = np.linalg.matrix_rank(constrained, tol=1e-9) if held.any() else 0
        if rank < np.linalg.matrix_rank(full, tol=1e-9):
            loose = [n for n, m in zip(names, constrained, strict=True) if not len(m) or np.abs(m).max() < 1e-12]
            raise InputError(
                f"bodies.{part.name}.supports",
                "a static start needs a supported body; free: " + (", ".join(loose) or "a combined rotation"),
                "supports that hold every rigid motion, or a start as given",
            )


def _require_apart(model: Model, u: Array) -> None:
    rows = model.candidates
    gap = rows.gap(u)
    size = max(float(np.ptp(p.mesh.points, axis=0).max()) for p in model.parts)
    if len(gap) and gap.min() < -1e-12 * size:
        worst = int(np.argmin(gap))
        contact = model.scene.contacts[rows.contact[worst]]
        raise InputError(
            f"contacts[{rows.contact[worst]}].between",
            f"'{contact.between[0]}' starts {-gap[worst]:.3g} m inside '{contact.between[1]}'",
            "a placement or displacement that leaves a gap",
        )
