"""Contact rows that depend on their own node alone."""

import numpy as np
import scipy.sparse as sp

from softway.contact.contact_rows import ContactRows, on_nodes
from softway.contact.stencils import normal_component
from softway.contact.tangential_rows import TangentialRows


def single(
    node: object, normal: object, offset: object, n: int, *, tool_motion: object = 0.0, contact: object = 0,
    labels: tuple[str, ...] = ("a",), masters: object = 0.0,
) -> ContactRows:  # fmt: skip
    """Rows (m,) of a model with ``n`` nodes; the motion of the opponent and the contact may be one for all rows.

    ``masters`` (m, n) are the weights of the nodes of deformable opponents.
    """
    node = np.asarray(node, int)
    return ContactRows(
        node=node,
        contact=np.broadcast_to(np.asarray(contact, int), node.shape),
        normal=np.asarray(normal, float),
        gradient=normal_component(
            sp.csr_array(on_nodes(node, n).toarray() - np.asarray(masters)), np.asarray(normal, float)
        ),
        offset=np.broadcast_to(np.asarray(offset, float), node.shape),
        tool_motion=np.broadcast_to(np.asarray(tool_motion, float), node.shape),
        labels=labels,
        shear=TangentialRows.none(len(node), n, np.shape(normal)[1]),
    )
