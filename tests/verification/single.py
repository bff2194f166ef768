"""Contact rows that depend on their own node alone."""

import numpy as np

from softway.contact.candidates import Candidates, on_nodes


def single(
    node: object, normal: object, offset: object, n: int, *, drive: object = 0.0, contact: object = 0,
    labels: tuple[str, ...] = ("a",),
) -> Candidates:  # fmt: skip
    """Rows (m,) of a model with ``n`` nodes; the motion of the opponent and the contact may be one for all rows."""
    node = np.asarray(node, int)
    return Candidates(
        node=node,
        contact=np.broadcast_to(np.asarray(contact, int), node.shape),
        normal=np.asarray(normal, float),
        weights=on_nodes(node, n),
        offset=np.broadcast_to(np.asarray(offset, float), node.shape),
        drive=np.broadcast_to(np.asarray(drive, float), node.shape),
        labels=labels,
    )
