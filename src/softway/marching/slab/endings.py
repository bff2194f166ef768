"""End of a march without an accepted slab (time step): the reason, and remedies."""

import numpy as np

from softway.laws.bulk import StVenantKirchhoff
from softway.marching.slab.slab_step import Stepper
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import CRAWL
from softway.model.model import Model
from softway.solve.methods.newton import Newton

CRUSHED = 0.7
"""Ratio of present to reference volume below which a message calls matter crushed."""
SHORT = 1e-2
"""Step without inertia, relative to that of the prescribed motion, below which a longer one is advised."""


def reason(march_state: MarchState, reasons: list[str], crawls: bool) -> str:
    """Reason for the end of a march."""
    if not reasons:
        return "no time step was accepted: bodies come to rest again and again"
    if crawls:
        count = march_state.step_history.recent_rejections + len(reasons)
        return f"{count:.0f} rejections among slabs shorter than {CRAWL:g} of the step; last: {reasons[-1]}"
    return f"no time step was accepted after {len(reasons)} cutbacks; last: {reasons[-1]}"


def touching(model: Model, now: ModelState) -> str:
    """Names of the contacts that are closed."""
    contacts = model.contacts
    closed = [contacts.labels[k] for k in np.unique(contacts.contact[now.closed]).tolist()]
    return f"; in contact: {', '.join(closed)}" if closed else ""


def crushed(model: Model, now: ModelState) -> str:
    """Names of the crushed bodies, with the volume that is left in one place."""
    left = _volumes_left(model, now)
    return "".join(f"; {name!r} is crushed to {100.0 * ratio:.2g} % of its volume" for name, ratio in left.items())


def _volumes_left(model: Model, now: ModelState) -> dict[str, float]:
    """Least ratio of present to reference volume of each crushed body."""
    u = now.start.displacement
    left = {p.name: p.internal.volume_ratio(u[p.nodes]) for p in model.parts}
    return {name: ratio for name, ratio in left.items() if ratio < CRUSHED}


def remedy(stepper: Stepper, march_state: MarchState, usual: float) -> str:
    """Possible remedies if no time step was accepted; without inertia very short slabs move nothing but rounding.

    ``usual`` is the automatic length [s].
    """
    short = not stepper.model.inert and march_state.step_history.span < SHORT * usual
    found = [f"a longer step, such as {usual:.3g} s" if short else "a smaller step"]
    found.append("a finer mesh where the cells are crushed")
    crushed = _volumes_left(stepper.model, march_state.state)
    laws = (law for p in stepper.model.parts if p.name in crushed for law in p.materials.laws)
    if any(type(law) is StVenantKirchhoff for law in laws):
        found.append("the material NeoHookean, which stiffens where StVenantKirchhoff softens under compression")
    if isinstance(stepper.method, Newton) and not stepper.method.handover:
        found.append("the method FixedPoint, which converges more often than Newton alone")
    if stepper.model.contacts.overlap_methods:  # mean gaps
        found.append("the method NodeToSurface for coarse facets in contact")
    return ", or ".join(found)
