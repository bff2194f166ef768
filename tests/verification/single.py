"""Contact rows that depend on their own node alone."""

import numpy as np
import scipy.sparse as sp

from softway.contact.candidates import Candidates, on_nodes
from softway.contact.stencils import along


def single(
    node: object, normal: object, offset: object, n: int, *, drive: object = 0.0, contact: object = 0,
    labels: tuple[str, ...] = ("a",), masters: object = 0.0,
) -> Candidates:  # fmt: skip
    """Rows (m,) of a model with ``n`` nodes; the motion of the opponent and the contact may be one for all rows.

    ``masters`` (m, n) are the weights of the nodes of deformable opponents.
    """
    node = np.asarray(node, int)
    return Candidates(
        node=node,
        contact=np.broadcast_to(np.asarray(contact, int), node.shape),
        normal=np.asarray(normal, float),
        gradient=along(sp.csr_array(on_nodes(node, n).toarray() - np.asarray(masters)), np.asarray(normal, float)),
        offset=np.broadcast_to(np.asarray(offset, float), node.shape),
        drive=np.broadcast_to(np.asarray(drive, float), node.shape),
        labels=labels,
    )
