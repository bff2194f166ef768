"""F09: the woodpecker toy: a sleeve that sticks and slips on a pole, and a bird whose beak hits it (Glocker)."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.mechanisms import Hinge, Mechanism, MechanismStep, PinSlot, PlaneStop, Rigid, Spring, StopEvent, march
from softway.mechanisms.members.joints import Joint
from softway.record.view.plots.curves import Curve, Panel

SLEEVE, BIRD = (0.0003, 5e-9), (0.0045, 7e-7)
"""Mass [kg] and moment of inertia [kg m^2]."""
SPRING, FRICTION, RESTITUTION, GRAVITY = 0.0056, 0.3, 0.5, 9.81
POLE, HOLE, HALF, HINGE, BODY, BEAK = 0.0025, 0.0031, 0.0058, 0.01, 0.015, (0.0201, 0.02)
"""Radius of the pole and of the hole of the sleeve, half its height, distances from the middle to the hinge and from
there to the bird, and of the beak from the bird, back and up [m].
"""
SMALL = 1e5
"""The model of the literature is linear in the angles.  Here lengths are greater by this factor and angles smaller:
heights, clearances, velocities and energies are the same.
"""
START = (-0.0006 / 0.0058, -0.2788), (-0.3411, 0.0, -7.4583)
"""Angles of sleeve and bird [rad], where the sleeve just touches the pole; velocities of y and of the angles."""


def _turned(angle: float, x: float, y: float) -> Array:
    """The vector (x, y) turned by an angle, all in the measures of the mechanism."""
    c, s = np.cos(angle / SMALL), np.sin(angle / SMALL)
    return SMALL * np.array([c * x - s * y, s * x + c * y])


def woodpecker() -> Mechanism:
    """Sleeve and bird at the start of the cycle of the literature."""
    (sleeve, bird), (fall, turning, pecking) = START
    hinge = _turned(sleeve, HINGE, 0.0)
    arm = _turned(bird, BODY, 0.0)
    swing = turning * np.array([-hinge[1], hinge[0]]) + pecking * np.array([-arm[1], arm[0]])
    bodies = {
        "sleeve": Rigid(
            mass=SLEEVE[0],
            centre=(0.0, 0.0),
            inertia=SLEEVE[1] * SMALL**2,
            velocity=(0.0, fall),
            spin=turning / SMALL,
        ),
        "bird": Rigid(
            mass=BIRD[0],
            centre=_place(hinge + arm),
            inertia=BIRD[1] * SMALL**2,
            velocity=_place(np.array([0.0, fall]) + swing / SMALL),
            spin=pecking / SMALL,
        ),
    }
    joints: dict[str, Joint] = {
        "pole": PinSlot(between=("ground", "sleeve"), at=(0.0, 0.0), axis=(0.0, 1.0)),
        "hinge": Hinge(between=("sleeve", "bird"), at=_place(hinge)),
    }
    spring = Spring(
        between=("sleeve", "bird"),
        ends=(_place(hinge + _turned(sleeve, -0.01, 0.01)), _place(hinge + _turned(bird, 0.0, 0.01))),
        stiffness=SPRING / 0.01**2,
        rest=0.01 * SMALL,
    )
    return Mechanism(
        bodies=bodies, joints=joints, stops=_stops(hinge + arm), springs=(spring,), gravity=(0.0, -GRAVITY)
    )


def _stops(bird: Array) -> dict[str, PlaneStop]:
    """Edges of the sleeve and the beak, against the pole; ``bird`` (2,) is the centre of the bird."""
    (turned, leaning), _ = START
    edges = {
        "beak": ("bird", bird + _turned(leaning, -BEAK[0], BEAK[1]), HINGE + BODY - BEAK[0], RESTITUTION),
        "upper": ("sleeve", _turned(turned, HOLE, HALF), HOLE, 0.0),
        "lower": ("sleeve", _turned(turned, HOLE, -HALF), HOLE, 0.0),
    }
    return {
        name: PlaneStop(
            between=("ground", body),
            point=_place(point),
            plane=(SMALL * upright - (upright - POLE), 0.0),
            normal=(1.0, 0.0),
            friction=FRICTION,
            restitution=restitution,
        )
        for name, (body, point, upright, restitution) in edges.items()
    }


def _place(at: Array) -> tuple[float, float]:
    return float(at[0]), float(at[1])


@cache
def pecked(until: float, step: float) -> tuple[MechanismStep, ...]:
    """Steps of the march."""
    return tuple(march(woodpecker(), until=until, step=step))


def beaks(steps: tuple[MechanismStep, ...]) -> list[StopEvent]:
    """Touches of the beak."""
    return [e for step in steps for e in step.events if e.stop == "beak" and e.kind == "touch"]


def compute() -> Outcome:
    """Compute the case."""
    coarse, fine = pecked(4.0, 1e-3), pecked(1.0, 1e-4)
    time = np.array([step.time for step in coarse])
    height = np.array([float(step.bodies["sleeve"].centre[1]) for step in coarse])
    hits = np.array([event.time for event in beaks(coarse)])
    at = np.interp(hits, time, height)
    cycles = slice(4, 25)  # an even number of cycles: their lengths alternate
    found = {
        "first beak impacts, h = 1 ms": hits[:7].tolist(),
        "first beak impacts, h = .1 ms": [event.time for event in beaks(fine)[:7]],
        "period": float(np.diff(hits[cycles]).mean()),
        "drop per cycle": float(-np.diff(at[cycles]).mean()),
        "energy [J]": max(abs(step.energy_error) for step in coarse),
    }
    curve = Curve(x=time, y=1e3 * height, label="h = 1 ms")
    return Outcome(values=found, panels=(Panel(title="Sleeve", x="t [s]", y="height [mm]", curves=(curve,)),))
