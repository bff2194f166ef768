"""Material state of a path-dependent body: history variables at the end of a slab."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from softway.arrays import Array, IntArray

OPTIONAL = (
    "viscous", "temperature", "warming", "stiffness", "stiffening", "eigenstrain", "coming_eigenstrain", "unforeseen",
)  # fmt: skip
"""Arrays (p, ...) of a state that are None where the law does not need them."""


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
    temperature, warming
        (p,) temperature of the points [K] and its rate in the slab before [K/s]; None for laws that do not need them.
    stiffness, stiffening
        (p,) factor of the moduli at the points and its rate in the slab before [1/s]; None where it is one.
    eigenstrain, coming_eigenstrain
        (p,) free strain that the law knows at the points, now and at the end of the coming slab; None where it knows
        none.
    unforeseen
        (p,) rate of the free strain in the slab before that was not foreseen [1/s].
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
    temperature: Array | None = None
    warming: Array | None = None
    stiffness: Array | None = None
    stiffening: Array | None = None
    eigenstrain: Array | None = None
    coming_eigenstrain: Array | None = None
    unforeseen: Array | None = None

    def __post_init__(self) -> None:
        for array in (self.displacement, self.stress, *self.law.values(), self.lateral, self.stored, self.dissipated):
            array.flags.writeable = False
        for name in OPTIONAL:
            some = getattr(self, name)
            if some is not None:
                some.flags.writeable = False

    def part(self, nodes: IntArray, points: IntArray) -> "MaterialState":
        """State of some nodes (k,) and points (q,)."""
        some = {name: values for name in OPTIONAL if (values := getattr(self, name)) is not None}
        return MaterialState(
            displacement=self.displacement[nodes],
            stress=self.stress[points],
            law={name: values[points] for name, values in self.law.items()},
            lateral=self.lateral[points],
            stored=self.stored[points],
            dissipated=self.dissipated[points],
            **{name: values[points] for name, values in some.items()},
        )

    def middle_temperature(self, span: float) -> Array | None:
        """Temperature (p,) in the middle of a slab of length ``span`` [s], extrapolated; None for laws without.

        Half of the temperature is its least value: it stays positive where a slab is too long for the cooling.
        """
        if self.temperature is None or self.warming is None:
            return self.temperature
        return np.maximum(self.temperature + 0.5 * span * self.warming, 0.5 * self.temperature)

    def coming_stiffness(self, span: float) -> Array | None:
        """Factor (p,) of the moduli at the end of a slab of length ``span`` [s], extrapolated, at least half of that at
        its start; None where it is one.
        """
        if self.stiffness is None or self.stiffening is None:
            return self.stiffness
        return np.maximum(self.stiffness + span * self.stiffening, 0.5 * self.stiffness)


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
