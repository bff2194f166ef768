"""The three rules of contact in time: what a touch inside a slab does to the velocity field."""

from dataclasses import dataclass
from typing import Literal

from softway.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Paper:
    """The paper's rule, literally: the touching node gets an extra time node, where its normal velocity becomes zero.

    Up to the instant t_c the velocity is ``kept`` or ``extrapolated`` linearly from the slab before; after it the
    normal velocity vanishes and the node is eliminated (Figs. 2 and 4).  The jump is not balanced by the
    neighbours, so the rule loses the kinetic energy that the node shares (docs/theory/contact.md).  Between two
    deformable bodies the touching nodes of both share it by their masses.

    Parameters
    ----------
    approach
        Velocity before the instant.
    split
        ``product`` keeps the elements beside the contact as products of space and time functions; ``triangle``
        divides them into the trapezoid and the triangle of Fig. 4 (two-node bars in one dimension).

    Examples
    --------
    >>> Paper().approach
    'kept'
    """

    approach: Literal["kept", "extrapolated"] = "kept"
    split: Literal["product", "triangle"] = "product"


@dataclass(frozen=True, slots=True, kw_only=True)
class Impulse:
    """The mass-consistent jump: ``v+ = v- - M^-1 G^T (G M^-1 G^T)^-1 G v-`` at the instant t_c.

    Momentum is balanced by all nodes; the kinetic energy ``1/2 p |v_n|`` of the jump is lost and entered as
    dissipation in the ledger.

    Examples
    --------
    >>> Impulse()
    Impulse()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class Energy:
    """Contact nodes without inertia, in constrained equilibrium, and the energy balance closed: the default.

    Parameters
    ----------
    located
        ``False``: one scalar a slab closes the balance, at any deformation.  ``True``: the instants of touch and
        release divide the slab exactly and no scalar is needed; small strain only (LinearElastic).
    spread
        Cells over which the inertia of the contact nodes is spread, at most half the depth of the body: more make the
        force start more smoothly, fewer keep the inertia nearer to its place (docs/theory/overshoot.md).

    Examples
    --------
    >>> Energy().located
    False
    """

    located: bool = False
    spread: int = 5

    def __post_init__(self) -> None:
        if self.spread < 1:
            raise InputError("spread", f"{self.spread} cells", "1 or more")


Timing = Paper | Impulse | Energy
