"""A01: eigenvalues of the amplification matrix of each virtual time function."""

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.exact import oscillator as exact
from softway.arrays import Array
from softway.model.time_weight import TimeWeight, amplification, limit, moments
from softway.record.view.plots.curves import Curve, Panel

WEIGHTS: dict[str, TimeWeight] = {
    "constant": sw.model.Momentum(),
    "peak at 0.5": sw.model.Collocation(at=(0.5,), weights=(1.0,)),
    "peak at 0.75": sw.model.Collocation(at=(0.75,), weights=(1.0,)),
    "peak at 1": sw.model.Collocation(at=(1.0,), weights=(1.0,)),
}


def compute() -> Outcome:
    """Compute the matrices of softway; the report also shows the closed form."""
    pairs = [(w, z) for w in WEIGHTS.values() for z in sheet("A01")["definition"]["z"]]
    values = [np.linalg.eigvals(amplification(w, z)) for w, z in pairs]
    swinging = [(v, z) for (w, z), v in zip(pairs, values, strict=True) if z <= limit(w)]
    found = {
        "spectral radius each z": [float(np.abs(v).max()) for v in values],
        "Omega/omega": [float(np.abs(np.angle(v[np.argmax(np.abs(v))])) / z) for v, z in swinging],
        "stability limit of const weighting": limit(sw.model.Momentum()),
    }
    return Outcome(values=found, panels=(_radii(),))


def _radii() -> Panel:
    z = np.linspace(0.05, 4.0, 80)
    ours = [Curve(x=z, y=_radius(w, z), label=name) for name, w in WEIGHTS.items()]
    closed = [
        Curve(x=z, y=[exact.radius(moments(w), x) for x in z], kind="exact", label="" if k else "closed form")
        for k, w in enumerate(WEIGHTS.values())
    ]
    return Panel(title="Growth over a slab", x="omega h", y="spectral radius", curves=(*ours, *closed))


def _radius(weight: TimeWeight, z: Array) -> list[float]:
    return [float(np.abs(np.linalg.eigvals(amplification(weight, x))).max()) for x in z]
