"""Heat of the dissipation of a path-dependent material at the nodes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import MaterialStates
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.material_state import MaterialState
from softway.heat.coupled.strain.expansion import pieces, point_values
from softway.laws.bulk.j2 import J2
from softway.laws.law import Material

METALS = 0.9
"""Share of plastic dissipation that heats metals; the rest is stored in dislocations (Taylor and Quinney, 1934)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Dissipation:
    """Dissipation of the elements of one law.

    Parameters
    ----------
    solid, region
        Number of the solid, and name of its region; empty for a solid of one law.
    nodes
        (k,) their nodes among those of all solids.
    values
        (p, k) functions of heat at the quadrature points.
    volume
        (p,) reference volumes of the points [m^3].
    share
        Share of the dissipation that heats.
    """

    solid: int
    region: str
    nodes: IntArray
    values: csr_array
    volume: Array
    share: float

    def energy(self, before: MaterialStates, after: MaterialStates) -> Array:
        """Energy (k,) dissipated in a slab between two material states of all solids, at the nodes [J]."""
        spent = self._points(after[self.solid]) - self._points(before[self.solid])
        return np.asarray(self.values.T @ (self.volume * spent))

    def _points(self, state: MaterialState | None) -> Array:
        """Dissipated energies (p,) [J/m^3]."""
        assert state is not None
        return state.regions[self.region].dissipated if self.region else state.dissipated


def dissipations(number: int, part: DiscreteSolid, share: float | None) -> Iterator[Dissipation]:
    """Dissipations of the path-dependent laws of the solid of this ``number``, with a share that heats."""
    whole = point_values(part)
    for region, _, nodes, points, internal, law in pieces(part):
        own = default_share(law) if share is None else share
        if internal.path_dependent:
            yield Dissipation(
                solid=number,
                region=region,
                nodes=nodes + part.nodes.start,
                values=csr_array(whole[points][:, nodes]),
                volume=internal.sampling.volume,
                share=own,
            )


def default_share(law: Material) -> float:
    """Share of the dissipation of a law that heats: .9 of plastic work in metals, all of viscous work.

    Examples
    --------
    >>> from softway.laws.bulk import Kelvin
    >>> default_share(Kelvin(E=1.0, nu=0.0, shear_viscosity=1.0))
    1.0
    """
    return METALS if isinstance(law, J2) else 1.0
