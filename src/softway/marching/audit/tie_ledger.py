"""Audit of ties that break: broken area, opening, and dissipated energy."""

from collections.abc import Sequence

import numpy as np

from softway.marching.results.step import TieLedger
from softway.marching.state.model_state import ModelState
from softway.model.model import Model


def tie_ledgers(model: Model, before: Sequence[float], start: ModelState, end: ModelState) -> dict[str, TieLedger]:
    """Audits of all ties that break after a slab, by label.

    Parameters
    ----------
    before
        Energy dissipated by each of them before the slab [J]; empty at the start of a march.
    start, end
        States at both ends of the slab.
    """
    found = {}
    for bond in model.bonds:
        number = model.companions.index(bond)
        first, last = (state.start.fields[number].values for state in (start, end))
        u = end.start.displacement
        for k, tie in enumerate(bond.ties):
            node, area = tie.jump.node, tie.jump.area
            spent = area @ tie.grown(first[node, k], u, bond.points + u)[1]
            found[tie.tie.label] = TieLedger(
                broken=float(area @ (last[node, k] >= 1.0) / area.sum()),
                opening=float(np.linalg.norm(tie.jump.rows @ u, axis=1).max()),
                dissipated=float(spent + (before[k] if before else 0.0)),
            )
    return found
