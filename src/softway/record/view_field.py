"""What colours a picture: a stored field as one number at each node, with its name, unit and colours."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.record.frames import Cells, Frame, Kind
from softway.record.layout import PAIRS
from softway.record.run import Run
from softway.record.surface import at_nodes
from softway.record.view_style import scaled
from softway.typing import Array

WORDS = {"von_mises": "von Mises stress", "dissipation": "dissipated energy"}
"""Names of fields that are not their words."""
SEQUENTIAL, DIVERGING = "viridis", "RdBu_r"
TENSOR = tuple("xyz"[i] + "xyz"[j] for i, j in PAIRS)
"""Names of the six components of a symmetric tensor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Colour:
    """A field ``name``, or one of its ``part`` such as "x" or "xy"; of vectors without a part the length."""

    name: str
    kind: Kind
    part: str = ""

    def at_nodes(self, cells: Cells, frame: Frame) -> Array:
        """Values (n,) at the nodes of a frame; of fields of cells the mean of those around."""
        values = frame[self.name]
        if values.ndim > 1:
            names = parts(self.kind)
            values = values[:, names.index(self.part)] if self.part else np.linalg.norm(values, axis=1)
        return values if self.kind.on == "nodes" else at_nodes(cells, values)

    @property
    def word(self) -> str:
        """The field in words."""
        found = WORDS.get(self.name, self.name.replace("_", " "))
        return f"{found} {self.part}".strip()

    def label(self, scale: float) -> tuple[float, str]:
        """Factor for the values, and the text beside the colours, for values of a size."""
        if not self.kind.unit:
            return 1.0, self.word
        factor, unit = prefixed(scale, self.kind.unit)
        return factor, f"{self.word} [{unit}]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Colours reach from ``low`` to ``high``; ``peaked``: values lie above."""

    low: float
    high: float
    peaked: bool = False

    @property
    def scale(self) -> float:
        """The greatest size."""
        return max(abs(self.low), abs(self.high))

    @property
    def map(self) -> str:
        """Name of the colours: diverging ones where values have both signs."""
        return DIVERGING if self.low < 0.0 else SEQUENTIAL


def colour_of(run: Run, wanted: str | None) -> Colour:
    """The field with a name such as ``velocity`` or ``stress.xy``.

    Without a name it is the plastic strain where there is any at the end, and von Mises stress otherwise.

    Raises
    ------
    InputError
        If the run has no such field; the message lists those it has.
    """
    kinds = run.fields.kinds
    if wanted is None:
        plastic = "plastic_strain" in kinds and len(run.fields) and bool(run.fields[-1]["plastic_strain"].any())
        wanted = "plastic_strain" if plastic else "von_mises"
    name, _, part = wanted.partition(".")
    if name not in kinds:
        raise InputError("--field", f"no field '{wanted}'", f"one of {', '.join(names(kinds.items()))}")
    allowed = parts(kinds[name])
    if part not in allowed and (part or kinds[name].components == len(TENSOR)):
        one = f"one of {', '.join(f'{name}.{p}' for p in allowed)}" if allowed else f"'{name}'"
        raise InputError("--field", f"no component '{wanted}'", one)
    return Colour(name=name, kind=kinds[name], part=part)


def names(kinds: Iterable[tuple[str, Kind]]) -> tuple[str, ...]:
    """What can be asked for: fields, of tensors the components."""
    found: list[str] = []
    for name, kind in kinds:
        found += [f"{name}.{part}" for part in TENSOR] if kind.components == len(TENSOR) else [name]
    return tuple(found)


def parts(kind: Kind) -> tuple[str, ...]:
    """Names of the components of a field."""
    return {3: ("x", "y", "z"), len(TENSOR): TENSOR}.get(kind.components, ())


def range_of(values: Array) -> Range:
    """Where colours begin and end: at zero and the greatest value, or where a few far above the others begin; both
    sides of zero alike where there are negative values.
    """
    most, usual = float(values.max()), float(np.percentile(values, 99.0))
    if values.min() < -1e-9 * max(most, 0.0) and values.min() < 0.0:
        size = float(np.percentile(np.abs(values), 99.5))
        return Range(low=-size, high=size, peaked=bool(np.abs(values).max() > size))
    top = usual if most > 2.0 * usual > 0.0 else most
    return Range(low=0.0, high=top, peaked=top < most)


def prefixed(value: float, unit: str) -> tuple[float, str]:
    """:func:`scaled`, also of products such as ``J/m^3``."""
    factor, found = scaled(value, unit)
    return factor, found.replace("^3", "³").replace("^2", "²")
