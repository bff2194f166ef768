"""Protocol of contact rules in time: solution of one slab (time step) with contact."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from softway.bodies.assembled.dashpots import Dashpots
from softway.bodies.setup.directions import directed
from softway.bodies.solid import Solid
from softway.errors import Cancel, InputError
from softway.marching.results.slab_result import SlabResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import TimeWeight
from softway.solve.effort import Effort
from softway.solve.equations.follower import Follower
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory

Method = FixedPoint | Newton | Explicit
Solutions = Iterator[tuple[SlabResult, OperatorMemory]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """One attempt at a slab.

    Parameters
    ----------
    approach
        Greatest approach of two surfaces in the slab, in edges; beyond it the slab is refused.
    lowest
        Length of the lowest rung under a tolerance [s]: in a longer slab no row may close.
    energy_along_motion
        True if an energy balance that the bounded scalar cannot close is closed along the motion.
    stick_at_any_force
        True if rows at rest stick at any force.
    cancel
        Callback between iterates that may cancel the march.
    effort
        Counted work of the attempt.
    positive_definite
        True if the operators have to be positive definite.
    rested
        True if bodies have come to rest at the start of the slab.
    guess
        Solution of the slab with rigid bodies in nearly the same motion; None without.
    tolerance
        Least tolerance of the iteration, relative to the greatest velocity.
    follower
        Supports whose motion follows from the forces on them; None without.
    dashpots
        Dashpots at massless nodes that have no equilibrium; None without.
    """

    approach: float = np.inf
    lowest: float = np.inf
    energy_along_motion: bool = False
    stick_at_any_force: bool = False
    cancel: Cancel | None = None
    effort: Effort = field(default_factory=Effort)
    positive_definite: bool = False
    rested: bool = False
    guess: Guess | None = None
    tolerance: float = 0.0
    follower: Follower | None = None
    dashpots: Dashpots | None = None


class SlabRule(Protocol):
    """A contact rule in time, prepared for a model: it solves one slab after another."""

    def solve(self, model: Model, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt) -> Solutions:
        """Solutions of a slab, each more accurate than the previous one, with the operator for the next slab.

        Parameters
        ----------
        model
            The model with its loads and path-dependent materials in this slab.
        now
            State at the start of the slab.
        memory
            Operator of the previous slab.

        Raises
        ------
        NoConvergence, TooFast
            If the iteration does not converge, or the slab is too long for the approach.
        """
        ...


class OwnRule(Protocol):
    """User-defined :class:`~softway.contact.impact_rule.ImpactRule`, which prepares its slab rule itself."""

    def slab_rule(self, model: Model, method: Method, weight: TimeWeight) -> SlabRule:
        """Prepare the rule for a model.

        Raises
        ------
        InputError
            If the rule does not fit the model, the method or the time weight.
        """
        ...


def require_frictionless(model: Model, rule: str) -> None:
    """Refuse friction for a rule without it.

    Raises
    ------
    InputError
        If a contact has friction.
    """
    if not model.friction.frictionless:
        raise InputError("contacts[0].friction", f"friction with {rule}", "the rule Energy, located = false")


def require_nodal(model: Model, rule: str, hanging: bool = False) -> None:
    """Refuse unknowns that move several components, for a rule that treats nodes one by one; with ``hanging``, for one
    that treats contact nodes so: others may hang.

    Raises
    ------
    InputError
        If the degrees of freedom are no components of nodes.
    """
    remedy = "the rule Energy, located = false, with FixedPoint or Newton"
    for part in model.parts:
        solid, nodes = model.scene.bodies[part.name], part.mesh.hanging
        if isinstance(solid, Solid) and any(directed(support) for support in solid.supports):
            raise InputError(f"bodies.{part.name}.supports", f"a support along a direction, with {rule}", remedy)
        if nodes is not None and (not hanging or len(nodes.at(model.touchable - part.nodes.start))):
            what = "hanging contact nodes" if hanging else "hanging nodes"
            raise InputError(f"bodies.{part.name}.mesh", f"{what}, with {rule}", remedy)
    if model.scene.ties:
        raise InputError("ties[0]", f"a tie, with {rule}", remedy)
    if model.dofs.components is None and all(part.dofs.components is not None for part in model.parts):
        raise InputError("dofs", f"unknowns that move several components, with {rule}", remedy)


def require_motion_alone(model: Model, rule: str) -> None:
    """Refuse companion fields, for a rule that evaluates the forces of solids only.

    Raises
    ------
    InputError
        If the model has companion fields.
    """
    if model.companions:
        names = ", ".join(c.field.name for c in model.companions)
        raise InputError(
            "fields", f"{names} with {rule}", "the rule Energy, located = false, with FixedPoint or Newton"
        )
