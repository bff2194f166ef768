"""Mechanisms of rigid bodies with known motions."""

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import numpy as np

from softway.arrays import Array
from softway.mechanisms import (
    BodyState,
    Hinge,
    Mechanism,
    MechanismStep,
    Rigid,
    Rod,
    Slider,
    Spring,
    Torque,
    march,
)
from softway.mechanisms.members.joints import Joint

GRAVITY = (0.0, -9.81)


def pendulum() -> Mechanism:
    """Point mass of 1 kg on a rod of 1 m, released horizontally."""
    rod = Rod(between=("ground", "mass"), ends=((0.0, 0.0), (1.0, 0.0)))
    return Mechanism(bodies={"mass": Rigid(mass=1.0, centre=(1.0, 0.0))}, joints={"rod": rod}, gravity=GRAVITY)


def double_pendulum() -> Mechanism:
    """Two point masses of 1 kg on rods of 1 m, both released horizontally."""
    bodies = {"upper": Rigid(mass=1.0, centre=(1.0, 0.0)), "lower": Rigid(mass=1.0, centre=(2.0, 0.0))}
    joints = {
        "first": Rod(between=("ground", "upper"), ends=((0.0, 0.0), (1.0, 0.0))),
        "second": Rod(between=("upper", "lower"), ends=((1.0, 0.0), (2.0, 0.0))),
    }
    return Mechanism(bodies=bodies, joints=joints, gravity=GRAVITY)


def four_bars(loops: int) -> Mechanism:
    """Chain of four-bar loops: upright cranks of 1 kg and 1 m, coupled at their tops, which move at 1 m/s."""
    bodies: dict[str, Rigid] = {}
    joints: dict[str, Joint] = {}
    for k in range(loops + 1):
        bodies[f"crank{k}"] = _rod(1.0, (k, 0.0), (k, 1.0), velocity=(0.5, 0.0), spin=-1.0)
        joints[f"base{k}"] = Hinge(between=("ground", f"crank{k}"), at=(float(k), 0.0))
    for k in range(loops):
        bodies[f"coupler{k}"] = _rod(1.0, (k, 1.0), (k + 1, 1.0), velocity=(1.0, 0.0))
        for side, j in (("left", k), ("right", k + 1)):
            joints[f"{side}{k}"] = Hinge(between=(f"crank{j}", f"coupler{k}"), at=(float(j), 1.0))
    return Mechanism(bodies=bodies, joints=joints, gravity=GRAVITY)


def slider_crank() -> Mechanism:
    """Uniform rods of 38 g as crank and connecting rod in a line, turning at 150 rad/s, and a slider of 76 g."""
    r, length, spin = 0.153, 0.306, 150.0
    bodies = {
        "crank": _rod(0.038, (0.0, 0.0), (r, 0.0), velocity=(0.0, 0.5 * r * spin), spin=spin),
        "rod": _rod(0.038, (r, 0.0), (r + length, 0.0), velocity=(0.0, 0.5 * r * spin), spin=-r * spin / length),
        "slider": Rigid(mass=0.076, centre=(r + length, 0.0), inertia=1e-5),
    }
    joints: dict[str, Joint] = {
        "main": Hinge(between=("ground", "crank"), at=(0.0, 0.0)),
        "pin": Hinge(between=("crank", "rod"), at=(r, 0.0)),
        "wrist": Hinge(between=("rod", "slider"), at=(r + length, 0.0)),
        "guide": Slider(between=("ground", "slider"), at=(r + length, 0.0), axis=(1.0, 0.0)),
    }
    return Mechanism(bodies=bodies, joints=joints, gravity=GRAVITY)


def _rod(
    mass: float,
    start: tuple[float, float],
    end: tuple[float, float],
    velocity: tuple[float, float] = (0.0, 0.0),
    spin: float = 0.0,
) -> Rigid:
    """Uniform thin rod in the plane."""
    one, other = np.asarray(start, float), np.asarray(end, float)
    x, y = (0.5 * (one + other)).tolist()
    inertia = mass * float((other - one) @ (other - one)) / 12.0
    return Rigid(mass=mass, centre=(x, y), inertia=inertia, velocity=velocity, spin=spin)


SQUEEZER: Mapping[str, float] = MappingProxyType(
    {
        "xa": -0.06934,
        "ya": -0.00227,
        "xb": -0.03635,
        "yb": 0.03273,
        "xc": 0.014,
        "yc": 0.072,
        "d": 28e-3,
        "da": 115e-4,
        "e": 2e-2,
        "ea": 1421e-5,
        "rr": 7e-3,
        "ra": 92e-5,
        "ss": 35e-3,
        "sa": 1874e-5,
        "sb": 1043e-5,
        "sc": 18e-3,
        "sd": 2e-2,
        "ta": 2308e-5,
        "tb": 916e-5,
        "u": 4e-2,
        "ua": 1228e-5,
        "ub": 449e-5,
        "zf": 2e-2,
        "zt": 4e-2,
        "fa": 1421e-5,
    }
)
"""Lengths of Andrews' squeezer [m] (Hairer and Wanner 1996, Solving Ordinary Differential Equations II, VII.7)."""
ANGLES = (-0.0617138900142764496358948458001, 0.0, 0.455279819163070380255912382449, 0.222668390165885884674473185609)
"""beta, Theta, gamma, Phi at the start; delta, Omega, epsilon follow."""
MORE_ANGLES = (0.487364979543842550225598953530, -0.222668390165885884674473185609, 1.23054744454982119249735015568)
MASSES = (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498)
INERTIAS = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)


def squeezer() -> Mechanism:
    """Andrews' squeezer mechanism of seven bodies, driven by a torque of 33 N mm."""
    s = SQUEEZER
    (be, th, ga, ph), (de, om, ep) = ANGLES, MORE_ANGLES
    a, b, c = np.array([s["xa"], s["ya"]]), np.array([s["xb"], s["yb"]]), np.array([s["xc"], s["yc"]])
    crank, meeting = s["rr"] * _along(be), s["rr"] * _along(be) - s["d"] * _along(be + th)
    centres = (
        s["ra"] * _along(be),
        crank - s["da"] * _along(be + th),
        b - s["sa"] * _across(ga) + s["sb"] * _along(ga),
        a + s["zt"] * _along(de) - (s["e"] - s["ea"]) * _across(ph + de),
        a + s["ta"] * _along(de) + s["tb"] * _across(de),
        a - s["u"] * _across(ep) + (s["zf"] - s["fa"]) * _along(om + ep),
        a - s["ua"] * _across(ep) - s["ub"] * _along(ep),
    )
    names = [f"k{k}" for k in range(1, 8)]
    bodies = {
        name: Rigid(mass=mass, centre=_pair(centre), inertia=inertia)
        for name, mass, centre, inertia in zip(names, MASSES, centres, INERTIAS, strict=True)
    }
    places = {
        ("ground", "k1"): np.zeros(2),
        ("k1", "k2"): crank,
        ("k2", "k3"): meeting,
        ("k2", "k4"): meeting,
        ("k2", "k6"): meeting,
        ("ground", "k3"): b,
        ("k4", "k5"): a + s["zt"] * _along(de),
        ("ground", "k5"): a,
        ("k6", "k7"): a - s["u"] * _across(ep),
        ("ground", "k7"): a,
    }
    joints = {f"{i}-{j}": Hinge(between=(i, j), at=_pair(at)) for (i, j), at in places.items()}
    hook = b - s["sc"] * _across(ga) + s["sd"] * _along(ga)
    spring = Spring(between=("k3", "ground"), ends=(_pair(hook), _pair(c)), stiffness=4530.0, rest=0.07785)
    torque = Torque(on="k1", value=33e-3)
    return Mechanism(bodies=bodies, joints=joints, springs=(spring,), torques=(torque,))


def _along(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])


def _across(angle: float) -> Array:
    return np.array([-np.sin(angle), np.cos(angle)])


def _pair(point: Array) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def bricard() -> Mechanism:
    """Orthogonal Bricard mechanism: five rods of 1 m, 1 kg and a section of 0.1 m x 0.1 m, six hinges across them.

    Gruebler's count gives no mobility, and it moves (IFToMM benchmark A04).
    """
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, -1, 0], [1, -1, 1], [0, -1, 1], [0, 0, 1]], float)
    axes = np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]], float)
    bodies = {}
    for k in range(5):
        along = corners[k + 1] - corners[k]
        own = 0.01 / 6.0 * along**2 + 1.01 / 12.0 * (1.0 - along**2)
        bodies[f"rod{k}"] = Rigid(mass=1.0, centre=_triple(0.5 * (corners[k] + corners[k + 1])), inertia=_triple(own))
    names = ["ground", *bodies, "ground"]
    joints = {
        f"hinge{k}": Hinge(between=(names[k], names[k + 1]), at=_triple(corners[k]), axis=_triple(axes[k]))
        for k in range(6)
    }
    return Mechanism(bodies=bodies, joints=joints, gravity=(0.0, -9.81, 0.0))


def _triple(point: Array) -> tuple[float, float, float]:
    return float(point[0]), float(point[1]), float(point[2])


def top() -> Mechanism:
    """Free body that turns about its middle axis, with a small disturbance."""
    return Mechanism(
        bodies={"top": Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 2.0, 3.0), spin=(0.01, 2.0, 0.01))}
    )


def angles(steps: Iterator[MechanismStep], name: str) -> Iterator[tuple[MechanismStep, float]]:
    """Steps with the angle turned by a body in the plane, more than a turn included; steps of less than half a turn."""
    total = last = 0.0
    for step in steps:
        now = heading(step.bodies[name])
        total += (now - last + np.pi) % (2.0 * np.pi) - np.pi
        last = now
        yield step, total


def heading(body: BodyState) -> float:
    """Angle of a body in the plane against its start, between -pi and pi."""
    return float(np.arctan2(body.rotation[1, 0], body.rotation[0, 0]))


def last(mechanism: Mechanism, until: float, step: float, every: int = 1000) -> tuple[MechanismStep, float]:
    """Last step, and the greatest error of the energy relative to the greatest energy on the way."""
    steps = list(march(mechanism, until=until, step=step, every=every))
    scale = max(s.energy_kinetic + abs(s.energy_potential) + abs(s.work) for s in steps)
    return steps[-1], max(abs(s.energy_error) for s in steps) / scale
