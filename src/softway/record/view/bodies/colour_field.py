"""Field that colours a picture: one value at each node, with its name, unit and colour range."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.record.read.cells import Cells
from softway.record.read.frames import Frame, Kind
from softway.record.read.records import Records
from softway.record.read.surface_mesh import at_nodes
from softway.record.view.style import scaled
from softway.record.write.grid.grid_layout import PAIRS

FROM_LEAST = ("temperature",)
"""Fields whose zero means nothing for a picture: their colours begin at the least value."""
WORDS = {"von_mises": "von Mises stress", "dissipation": "dissipated energy"}
"""Displayed names of fields that differ from their keys."""
SEQUENTIAL, DIVERGING = "viridis", "RdBu_r"
TENSOR = tuple("xyz"[i] + "xyz"[j] for i, j in PAIRS)
"""Names of the six components of a symmetric tensor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Colour:
    """Field ``name``, or its component ``part`` such as "x" or "xy"; without a part the magnitude of a vector."""

    name: str
    kind: Kind
    part: str = ""

    def of(self, frame: Frame) -> Array:
        """Values (n,) at the nodes of a frame, or (e,) in its cells."""
        values = frame[self.name]
        if values.ndim > 1:
            names = parts(self.kind)
            values = values[:, names.index(self.part)] if self.part else np.linalg.norm(values, axis=1)
        return values

    def at_nodes(self, cells: Cells, frame: Frame) -> Array:
        """Values (n,) at the nodes of a frame; for cell fields the mean of the adjacent cells."""
        values = self.of(frame)
        return values if self.kind.on == "nodes" else at_nodes(cells, values)

    @property
    def word(self) -> str:
        """Name of the field for people."""
        found = WORDS.get(self.name, self.name.replace("_", " "))
        return f"{found} {self.part}".strip()

    def label(self, scale: float) -> tuple[float, str]:
        """Factor for the values, and label of the colour bar, for values of a given size."""
        if not self.kind.unit:
            return 1.0, self.word
        factor, unit = prefixed(scale, self.kind.unit)
        return factor, f"{self.word} [{unit}]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Range of the colours from ``low`` to ``high``; ``peaked`` is True if some values lie outside."""

    low: float
    high: float
    peaked: bool = False

    @property
    def scale(self) -> float:
        """Largest magnitude in the range."""
        return max(abs(self.low), abs(self.high))

    @property
    def map(self) -> str:
        """Name of the colour map; it is diverging if values have both signs."""
        return DIVERGING if self.low < 0.0 else SEQUENTIAL


def colour_of(run: Records, wanted: str | None) -> Colour:
    """Find the field with a name such as ``velocity`` or ``stress.xy``.

    Without a name it is the temperature of conductors, the plastic strain if there is any at the end of the run, and
    von Mises stress otherwise.

    Raises
    ------
    InputError
        If the run has no such field; the message lists the recorded fields.
    """
    kinds = run.fields.kinds
    if wanted is None:
        plastic = "plastic_strain" in kinds and len(run.fields) and bool(run.fields[-1]["plastic_strain"].any())
        wanted = "temperature" if run.of_heat else "plastic_strain" if plastic else "von_mises"
    name, _, part = wanted.partition(".")
    if name not in kinds:
        raise InputError("--field", f"no field '{wanted}'", f"one of {', '.join(names(kinds.items()))}")
    allowed = parts(kinds[name])
    if part not in allowed and (part or kinds[name].components == len(TENSOR)):
        one = f"one of {', '.join(f'{name}.{p}' for p in allowed)}" if allowed else f"'{name}'"
        raise InputError("--field", f"no component '{wanted}'", one)
    return Colour(name=name, kind=kinds[name], part=part)


def names(kinds: Iterable[tuple[str, Kind]]) -> tuple[str, ...]:
    """Names for :func:`colour_of`: fields, and for tensors their components."""
    found: list[str] = []
    for name, kind in kinds:
        found += [f"{name}.{part}" for part in TENSOR] if kind.components == len(TENSOR) else [name]
    return tuple(found)


def parts(kind: Kind) -> tuple[str, ...]:
    """Names of the components of a field."""
    return {3: ("x", "y", "z"), len(TENSOR): TENSOR}.get(kind.components, ())


UNIFORM = 1e-9
"""Difference of temperatures, relative to the greatest, that passes for rounding."""


def range_of(values: Array, name: str = "") -> Range:
    """Range of the colours: from zero to the largest value, without a few values that are far above the others.

    With negative values the range is symmetric about zero.  Temperatures have a range from the least to the greatest;
    solids without heat, whose temperature is recorded as zero, do not count.

    Examples
    --------
    >>> range_of(np.array([0.0, 300.0, 350.0]), "temperature")
    Range(low=300.0, high=350.0, peaked=False)
    """
    if name in FROM_LEAST:
        given = values[values > 0.0] if (values > 0.0).any() else values
        low, high = float(given.min()), float(given.max())
        if high - low <= UNIFORM * abs(high):
            return Range(low=low - 0.5, high=low + 0.5)
        return Range(low=low, high=high)
    most, usual = float(values.max()), float(np.percentile(values, 99.0))
    if values.min() < -1e-9 * max(most, 0.0) and values.min() < 0.0:
        size = float(np.percentile(np.abs(values), 99.5))
        return Range(low=-size, high=size, peaked=bool(np.abs(values).max() > size))
    top = usual if most > 2.0 * usual > 0.0 else most
    return Range(low=0.0, high=top, peaked=top < most)


def prefixed(value: float, unit: str) -> tuple[float, str]:
    """Scale a value like :func:`scaled`, also for compound units such as ``J/m^3``."""
    factor, found = scaled(value, unit)
    return factor, found.replace("^3", "³").replace("^2", "²")
