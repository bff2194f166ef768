"""What the points of a body remember from one slab to the next."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Memory:
    """The past of a body whose law has a history; arrays are read-only.

    Parameters
    ----------
    displacement
        (n, d) nodes at the time it is the memory of [m].
    stress
        (p, 3, 3) Cauchy stress at the points [Pa].
    law
        What the law remembers, arrays (p, ...) by name.
    lateral
        (p, k) stretch of the free axes.
    stored, dissipated
        (p,) energies taken up since the start per reference volume [J/m^3].
    viscous
        (p, 3, 3) the part of the stress that the mean rate of the last slab has made [Pa].
    """

    displacement: Array
    stress: Array
    law: Mapping[str, Array]
    lateral: Array
    stored: Array
    dissipated: Array
    viscous: Array | None = None

    def __post_init__(self) -> None:
        for array in (self.displacement, self.stress, *self.law.values(), self.lateral, self.stored, self.dissipated):
            array.flags.writeable = False
        if self.viscous is not None:
            self.viscous.flags.writeable = False

    def part(self, nodes: IntArray, points: IntArray) -> "Memory":
        """The memory of some nodes (k,) and points (q,)."""
        return Memory(
            displacement=self.displacement[nodes],
            stress=self.stress[points],
            law={name: values[points] for name, values in self.law.items()},
            lateral=self.lateral[points],
            stored=self.stored[points],
            dissipated=self.dissipated[points],
            viscous=None if self.viscous is None else self.viscous[points],
        )


def virgin(law: Mapping[str, Array], nodes: tuple[int, int], points: int, free: int) -> Memory:
    """The memory of ``points`` to which nothing has happened, on ``nodes`` (n, d), with some ``free`` axes."""
    return Memory(
        displacement=np.zeros(nodes),
        stress=np.zeros((points, 3, 3)),
        law=dict(law),
        lateral=np.ones((points, free)),
        stored=np.zeros(points),
        dissipated=np.zeros(points),
    )
