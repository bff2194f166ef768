"""Impact rules: effect of a touch inside a slab (time step) on the velocity field."""

from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol

from softway.errors import InputError


class ImpactRule(Protocol):
    """Declared impact rule.

    A user-defined rule also has ``slab_rule(model, method, weight)``, which prepares it for a march, see
    :class:`softway.marching.rules.slab_rule.OwnRule`.
    """

    @property
    def massless(self) -> bool:
        """True if contact nodes have no inertia."""
        ...

    @property
    def spread(self) -> int:
        """Number of cells over which the inertia of massless contact nodes is spread."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Paper:
    """The literal rule of the paper: the touching node gets an extra time node, where its normal velocity becomes zero.

    Up to the instant t_c the velocity is ``kept`` or ``extrapolated`` linearly from the slab before; after it the
    normal velocity vanishes and the node is eliminated (Figs. 2 and 4).  The neighbours do not balance the jump, so the
    rule loses the kinetic energy of the node (docs/theory/contact/contact.md).  Between two deformable bodies the
    touching nodes of both share the jump in proportion to their masses.  Nodes without an inertia of their own
    (corners of tri6, tet10, quad8 and hex20 with the consistent mass) are stopped as by ``Impulse``.  The stop of a
    node may create energy where its neighbours move against it; the audit then has a finding.  Friction is that of
    ``Impulse``.

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

    massless: ClassVar[bool] = False
    spread: ClassVar[int] = 1

    approach: Literal["kept", "extrapolated"] = "kept"
    split: Literal["product", "triangle"] = "product"


@dataclass(frozen=True, slots=True, kw_only=True)
class Impulse:
    """Mass-consistent velocity jump: ``v+ = v- - M^-1 G^T (G M^-1 G^T)^-1 G v-`` at the instant t_c.

    All nodes balance the momentum.  The kinetic energy ``1/2 p |v_n|`` of the jump is lost; the ledger counts it as
    dissipation.  Friction acts by impulses of whole slabs, those of jumps included: sliding is of second order in time,
    a touch of first (docs/theory/contact/friction.md).

    Examples
    --------
    >>> Impulse()
    Impulse()
    """

    massless: ClassVar[bool] = False
    spread: ClassVar[int] = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Energy:
    """The default rule: massless contact nodes in constrained equilibrium, and a closed energy balance.

    Nodes inside the body carry the mass.  Walls one linear cell thick get such nodes at half their thickness.

    Parameters
    ----------
    located
        ``False``: one scalar in each slab closes the balance, at any deformation.  ``True``: the instants of touch and
        release divide the slab exactly and no scalar is needed; for small strain only (LinearElastic).
    spread
        Number of cells over which the inertia of the contact nodes is spread, at most half the depth of the body: more
        cells make the force start more smoothly, fewer keep the inertia closer to its place
        (docs/theory/contact/overshoot.md).
    calm
        Filter of the velocity at the end of slabs in which bodies slip, from 0 (none) to 1, against flutter that the
        slabs do not resolve: ``0.2`` stops it where slabs are longer than 4 over its angular frequency.  The energy
        that it takes is part of the dissipation.  A resolved vibration of angular frequency w loses the part
        ``calm (h w/2)^4`` of its energy in a slab of length h (docs/theory/contact/friction.md).  For the methods
        FixedPoint and Newton, without rigid bodies.

    Examples
    --------
    >>> Energy().located, Energy(calm=0.2).calm
    (False, 0.2)
    """

    massless: ClassVar[bool] = True

    located: bool = False
    spread: int = 5
    calm: float = 0.0

    def __post_init__(self) -> None:
        if self.spread < 1:
            raise InputError("spread", f"{self.spread} cells", "1 or more")
        if not 0.0 <= self.calm <= 1.0:
            raise InputError("calm", f"{self.calm:g}", "a number from 0 to 1, such as 0.2")
        if self.located and self.calm > 0.0:
            raise InputError("calm", f"{self.calm:g} with located = true, which has no friction", "located = false")


__all__ = ["Energy", "Impulse", "Paper"]
