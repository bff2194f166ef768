"""Tangent stiffness of all solids."""

from collections.abc import Sequence

import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid


def assembled_tangent(parts: Sequence[DiscreteSolid], u: Array) -> sp.csc_array:
    """Tangent stiffness (n d, n d) of all solids [N/m]."""
    blocks = [part.tangent(u[part.nodes]) for part in parts]
    return blocks[0] if len(blocks) == 1 else sp.csc_array(sp.block_diag(blocks, format="csc"))
