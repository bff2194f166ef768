"""Friction on half-spaces, for compiled slabs in which all rows stick or slip as before."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.kernels.slab.friction import Friction
from softway.laws.friction import Coulomb, StaticKinetic
from softway.marching.slab.rows.driven import tool_motion
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState
from softway.model.model import Model


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldRows:
    """Rows that make up the contact of slabs, by their numbers among normal and then tangential rows.

    Parameters
    ----------
    active
        (k,) rows with unknown forces: closed ones, and tangential rows that stick.
    slip, partner
        (j,) tangential rows that slip, and their normal rows.
    factor
        (j,) ratios of their forces.
    sticks
        (m,) closed rows that stick.
    """

    active: IntArray
    slip: IntArray
    partner: IntArray
    factor: Array
    sticks: BoolArray

    @property
    def key(self) -> bytes:
        """Bytes that differ if the rows differ."""
        return b"".join(each.tobytes() for each in (self.active, self.slip, self.factor))


def proportional(model: Model) -> bool:
    """True if no contact has friction, or all have friction in proportion to the pressure on tools."""
    if model.friction.frictionless:
        return True
    return not model.contacts.paired and all(_ratios(law) is not None for law in model.friction.laws)


def _ratios(law: object) -> tuple[float, float] | None:
    """Greatest ratio of tangential to normal force at rest, and the ratio in slip; None if they are no constants."""
    match law:
        case Coulomb(mu=mu) if mu > 0.0:
            return float(mu), float(mu)
        case StaticKinetic(mu_s=static, mu_k=kinetic) if kinetic > 0.0:
            return float(static), float(kinetic)
    return None


def held_rows(model: Model, rows: ContactRows, now: ModelState) -> HeldRows | None:
    """Rows of the slabs from a state on; None where slip may turn: in space only sticking is certain."""
    closed = now.pressure > 0.0
    m, k = rows.shear.tangents.shape[:2]
    if not rows.shear.count:
        return without_friction(closed)
    sliding = np.flatnonzero(now.sliding)
    force = rows.shear.flat(now.traction)
    if (now.sliding & ~closed).any() or (k > 1 and len(sliding)) or not force[sliding].all():
        return None
    sticks = closed & ~now.sliding
    ratio = np.array([(_ratios(law) or (0.0, 0.0))[1] for law in model.friction.laws])[rows.contact]
    tangential = m + (np.flatnonzero(sticks)[:, None] * k + np.arange(k)).ravel()
    return HeldRows(
        active=np.concatenate([np.flatnonzero(closed), tangential]),
        slip=m + sliding,
        partner=sliding,
        factor=np.sign(force[sliding, 0]) * ratio[sliding] if len(sliding) else np.zeros(0),
        sticks=sticks,
    )


def without_friction(closed: BoolArray) -> HeldRows:
    """Closed normal rows (m,) without tangential ones."""
    none = np.zeros(0, np.int64)
    return HeldRows(active=np.flatnonzero(closed), slip=none, partner=none, factor=np.zeros(0), sticks=closed)


def every_row(rows: ContactRows) -> sp.csr_array:
    """Normal rows, and the tangential ones below (M, N)."""
    found = sp.vstack([rows.gradient, rows.shear.gradient()], format="csr") if rows.shear.count else rows.gradient
    out = sp.csr_array(found, copy=True)
    out.sort_indices()
    return out


def friction_table(model: Model, rows: ContactRows, held: HeldRows, march_state: MarchState) -> Friction | None:
    """Table of the friction of slabs; None without friction."""
    if not rows.shear.count:
        return None
    limit = np.array([(_ratios(law) or (0.0, 0.0))[0] for law in model.friction.laws])
    followed = sp.csr_array(rows.shear.gradient() @ sp.kron(model.follow, sp.eye_array(model.shape[1]), format="csr"))
    return Friction(
        tangents=rows.shear.tangents.shape[1],
        limit=limit[rows.contact],
        sticks=held.sticks,
        start=followed.indptr.astype(np.int64),
        component=followed.indices.astype(np.int64),
        value=followed.data.astype(float),
        heat=np.zeros(len(model.parts)),
        power=np.zeros((len(rows.labels), 2 + model.shape[1])),
        lost=np.array([march_state.account.dissipation]),
    )


def slip_velocity(model: Model, rows: ContactRows, moved: Array, times: tuple[float, float]) -> Array | None:
    """Mean velocity of the slip (m, d) in a slab between two ``times`` in which the nodes move by ``moved`` (n, d)."""
    if not rows.shear.count:
        return None
    slip = np.asarray(rows.shear.weights @ moved) - tool_motion(model, times)
    return rows.shear.vectors(rows.shear.flat(slip)) / (times[1] - times[0])
