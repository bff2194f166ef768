"""Slab rules of the declared contact rules."""

from collections.abc import Callable, Mapping
from typing import Any, cast

from softway.contact.impact_rule import Energy, Impulse, Paper
from softway.marching.rules.central_difference import central_difference
from softway.marching.rules.equilibrated import equilibrated
from softway.marching.rules.exact_instants import exact_instants
from softway.marching.rules.impulsive import inelastic_impact, nodal_stop
from softway.marching.rules.slab_rule import Method, OwnRule, SlabRule
from softway.model.model import Model
from softway.model.time_weight import TimeWeight
from softway.solve.methods.central_difference import Explicit


def _energy(model: Model, method: Any, weight: TimeWeight) -> SlabRule:
    rule = exact_instants if cast(Energy, model.timing).located else equilibrated
    return rule(model, method, weight)


RULES: Mapping[type, Callable[[Model, Any, TimeWeight], SlabRule]] = {
    Energy: _energy,
    Impulse: inelastic_impact,
    Paper: nodal_stop,
}
"""Slab rule of each declared rule for iterative methods."""


def slab_rule(model: Model, method: Method, weight: TimeWeight) -> SlabRule:
    """Prepare the contact rule of a model.

    A declared rule that is not among ``RULES`` prepares its own, see
    :class:`~softway.marching.rules.slab_rule.OwnRule`.

    Raises
    ------
    InputError
        If the rule does not fit the material, the method or the time weight.
    """
    if type(model.timing) not in RULES:
        return cast(OwnRule, model.timing).slab_rule(model, method, weight)
    if isinstance(method, Explicit):
        return central_difference(model, method, weight)
    return RULES[type(model.timing)](model, method, weight)
