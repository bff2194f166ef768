"""The rows of a contact as stencils: a gap, a direction, and the weights of the nodes that it depends on."""

from dataclasses import dataclass

import scipy.sparse as sp

from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stencils:
    """Gaps at one configuration with their derivatives ``d gap_r = normal_r . sum_j weights[r, j] dx_j``.

    Parameters
    ----------
    gap
        (m,) [m], negative inside the opponent; infinite where nothing is in reach.
    normal
        (m, d) unit normals, out of the opponent into free space.
    weights
        (m, n) one on the slave node, minus the weights of the nodes of a deformable opponent.
    """

    gap: Array
    normal: Array
    weights: sp.csr_array
