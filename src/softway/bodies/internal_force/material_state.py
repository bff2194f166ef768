"""Material state of a path-dependent body: history variables at the end of a slab."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from softway.arrays import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MaterialState:
    """History variables of a body with a path-dependent law at one time; arrays are read-only.

    Parameters
    ----------
    displacement
        (n, d) displacement of the nodes at that time [m].
    stress
        (p, 3, 3) Cauchy stress at the points [Pa].
    law
        History variables of the law, arrays (p, ...) by name.
    lateral
        (p, k) stretches of the free axes.
    stored, dissipated
        (p,) energies stored and dissipated since the start of the march per reference volume [J/m^3].
    viscous
        (p, 3, 3) part of the stress due to the mean rate of the last slab [Pa]; None without viscosity.
    regions
        States of the regions with a path-dependent law in a body with several materials, which has no points of its
        own; empty for a body with one.
    elastic
        Stored energy of all other regions [J].
    """

    displacement: Array
    stress: Array
    law: Mapping[str, Array]
    lateral: Array
    stored: Array
    dissipated: Array
    viscous: Array | None = None
    regions: Mapping[str, "MaterialState"] = field(default_factory=dict)
    elastic: float = 0.0

    def __post_init__(self) -> None:
        for array in (self.displacement, self.stress, *self.law.values(), self.lateral, self.stored, self.dissipated):
            array.flags.writeable = False
        if self.viscous is not None:
            self.viscous.flags.writeable = False

    def part(self, nodes: IntArray, points: IntArray) -> "MaterialState":
        """State of some nodes (k,) and points (q,)."""
        return MaterialState(
            displacement=self.displacement[nodes],
            stress=self.stress[points],
            law={name: values[points] for name, values in self.law.items()},
            lateral=self.lateral[points],
            stored=self.stored[points],
            dissipated=self.dissipated[points],
            viscous=None if self.viscous is None else self.viscous[points],
        )


def initial_history(law: Mapping[str, Array], nodes: tuple[int, int], points: int, free: int) -> MaterialState:
    """Initial state of an undeformed body.

    Parameters
    ----------
    law
        Initial history variables of the law, arrays (p, ...) by name.
    nodes
        Shape (n, d) of the nodal fields.
    points
        Number p of points.
    free
        Number of free axes.
    """
    return MaterialState(
        displacement=np.zeros(nodes),
        stress=np.zeros((points, 3, 3)),
        law=dict(law),
        lateral=np.ones((points, free)),
        stored=np.zeros(points),
        dissipated=np.zeros(points),
    )


def regional_history(displacement: Array, regions: Mapping[str, MaterialState], elastic: float) -> MaterialState:
    """State of a body with several materials: displacement (n, d) [m], states of the regions with a path-dependent law,
    and the stored energy of the others [J].
    """
    return MaterialState(
        displacement=displacement,
        stress=np.zeros((0, 3, 3)),
        law={},
        lateral=np.ones((0, 0)),
        stored=np.zeros(0),
        dissipated=np.zeros(0),
        regions=dict(regions),
        elastic=elastic,
    )
