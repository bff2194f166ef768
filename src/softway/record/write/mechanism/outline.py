"""mechanism.json: names, places and given velocities of the parts of a mechanism at the start, for pictures."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from softway.mechanisms.members.joints import GROUND, Cylindrical, PinSlot, Rod, Slider
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.springs import Spring
from softway.mechanisms.members.stops import AngleStop, DistanceStop, PlaneStop
from softway.record.write.mechanism.probes import TURNING, BodyReading

FILE = "mechanism.json"
ENTRIES: Mapping[str, type] = MappingProxyType(
    {"dim": int, "bodies": dict, "velocities": dict, "spins": dict, "joints": list, "stops": list, "springs": list}
)
"""Entries of every file, and their types."""


def outline(mechanism: Mechanism, readings: Sequence[BodyReading] = ()) -> dict[str, Any]:
    """Parts of a mechanism as plain data: centres and given motions of the bodies, and points of the other parts.

    Examples
    --------
    >>> from softway.mechanisms import Hinge, Rigid
    >>> arm = Mechanism(bodies={"arm": Rigid(mass=1.0, centre=(1.0, 0.0), inertia=0.3)},
    ...                 joints={"pivot": Hinge(between=("ground", "arm"), at=(0.0, 0.0))})
    >>> outline(arm)["joints"]
    [{'name': 'pivot', 'kind': 'Hinge', 'between': ['ground', 'arm'], 'points': [[0.0, 0.0], [0.0, 0.0]]}]
    """
    joints = [
        _part(name, joint, joint.between, joint.ends if isinstance(joint, Rod) else (joint.at, joint.at))
        for name, joint in mechanism.joints.items()
    ]
    for found, joint in zip(joints, mechanism.joints.values(), strict=True):
        if isinstance(joint, Slider | Cylindrical | PinSlot):
            found["axis"] = [float(x) for x in joint.axis]
    return {
        "dim": mechanism.dim,
        "bodies": {name: [float(x) for x in body.centre] for name, body in mechanism.bodies.items()},
        "velocities": {name: body.motion[0][: body.dim].tolist() for name, body in mechanism.bodies.items()},
        "spins": {
            name: body.motion[1][2 if body.dim == 2 else 0 :].tolist() for name, body in mechanism.bodies.items()
        },
        "joints": joints,
        "stops": [_stop(name, stop) for name, stop in mechanism.stops.items() if not isinstance(stop, AngleStop)],
        "springs": [
            _part(f"springs[{k}]", s, s.between, s.ends)
            for k, s in enumerate(mechanism.springs)
            if isinstance(s, Spring)
        ],
        "probes": [
            {"name": r.name, "body": r.body, "at": r.start.tolist()} for r in readings if r.quantity not in TURNING
        ],
    }


def _part(name: str, part: object, between: Sequence[str], points: Sequence[Sequence[float]]) -> dict[str, Any]:
    return {
        "name": name,
        "kind": type(part).__name__,
        "between": list(between),
        "points": [[float(x) for x in point] for point in points],
    }


def _stop(name: str, stop: PlaneStop | DistanceStop) -> dict[str, Any]:
    """Stop as plain data; the first point lies on the first body."""
    if isinstance(stop, PlaneStop):
        found = _part(name, stop, stop.between, (stop.plane, stop.point))
        return {**found, "normal": list(stop.normal), "radius": float(stop.radius)}
    return {**_part(name, stop, stop.between, stop.points), "distance": float(stop.distance), "side": stop.side}


def sound(parts: Mapping[str, Any]) -> bool:
    """True if what a file says has the form that :func:`outline` writes.

    Examples
    --------
    >>> from softway.mechanisms import Rigid
    >>> found = outline(Mechanism(bodies={"a": Rigid(mass=1.0, centre=(1.0, 0.0))}))
    >>> sound(found), sound({**found, "bodies": {"a": [1.0]}})
    (True, False)
    """
    try:
        dim, names = parts["dim"], {*parts["bodies"], GROUND}
        places = [*parts["bodies"].values(), *parts["velocities"].values(), *(p["at"] for p in parts["probes"])]
        linked = [*parts["joints"], *parts["stops"], *parts["springs"]]
        for part in linked:
            places += [*part["points"], *(part[key] for key in ("axis", "normal") if key in part)]
        known = all(len(part["points"]) == len(part["between"]) == 2 for part in linked)
        known &= all({*part["between"]} <= names and isinstance(part["name"], str) for part in linked)
        known &= all(p["body"] in names for p in parts["probes"])
        known &= parts["velocities"].keys() == parts["spins"].keys() == parts["bodies"].keys()
        known &= all(len(spin) == 2 * dim - 3 for spin in parts["spins"].values())
        known &= all(part["kind"] != "PlaneStop" or "normal" in part for part in parts["stops"])
        sizes = [s["radius"] if s["kind"] == "PlaneStop" else s["distance"] for s in parts["stops"]]
        numbers = np.array(
            [float(x) for x in (*sizes, *(x for place in (*places, *parts["spins"].values()) for x in place))]
        )
        known &= dim in (2, 3) and all(len(place) == dim for place in places)
        return bool(known and np.isfinite(numbers).all())
    except (TypeError, ValueError, KeyError, AttributeError):
        return False
