"""Elements at the contact for the split of Fig. 4."""

import numpy as np

from softway.contact.slab_motion.trapezoid_triangle import TrapezoidTriangle
from softway.errors import InputError
from softway.model.model import Model


def split_elements(model: Model) -> TrapezoidTriangle:
    """Two-node bars at the contact rows, for the split of Fig. 4.

    Raises
    ------
    InputError
        If the scene does not consist of straight two-node bars of LinearElastic in one dimension with contact at their
        ends.
    """
    where = "contacts[0].timing.split"
    bars = model.shape[1] == 1 and all(set(p.mesh.blocks) == {"bar2"} for p in model.parts)
    if not (bars and model.linear):
        raise InputError(where, "'triangle' is for two-node bars of LinearElastic in 1D", "split = 'product'")
    stiffness = model.tangent(np.zeros(model.shape)).tocsr()
    inner, value = [], []
    for node in model.contacts.node:
        row = stiffness[[node]].tocoo()
        others = row.coords[1] != node
        if others.sum() != 1:
            raise InputError(where, f"node {node} is not the end of a bar", "contact tags at the ends of bars")
        inner.append(int(row.coords[1][others][0]))
        value.append(-float(row.data[others][0]))
    return TrapezoidTriangle(inner=np.array(inner, int), stiffness=np.array(value))
