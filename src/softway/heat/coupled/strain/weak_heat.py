"""Heats of solids in a stage in which hardly any heat flows from node to node, balanced by a kernel."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softway.arrays import Array
from softway.bodies.setup.heat_loads import Convection, HeatFlux
from softway.heat.coupled.strain.moduli import ElasticHeat
from softway.heat.heat_balance import Balance, Stage, factors, powers, prescribed
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import HeatModel
from softway.heat.heat_slab import MOVING
from softway.heat.operators import HeatValues, heat_values
from softway.kernels.linalg.weak_balance import balanced


def balanced_heats(
    model: HeatModel, before: HeatValues, stage: Stage, strain: ElasticHeat, guess: Array, floor: float
) -> Balance | None:
    """Balance of the heats at the end of a stage, for a linear model of weakly coupled nodes.

    Parameters
    ----------
    model, before, stage, strain
        As of :func:`~softway.heat.heat_slab.solve_stage`; the moduli do not depend on the temperature.
    guess
        (n,) temperatures from which the iteration starts [K].
    floor
        Rounding of the sum of the heats [J].

    Returns
    -------
    found
        None if the heats cannot be balanced.
    """
    assert model.conduction is not None and model.capacity is not None
    end, given, fluids = prescribed(model, guess, stage.end), stage.span * strain.power, []
    for power in powers(model, stage):
        given = given + stage.span * power
    for surface, factor in zip(model.surfaces, factors(model, stage), strict=True):
        match surface.load:
            case HeatFlux(value=flux):
                given = given + stage.span * (surface.points.T @ (surface.areas * flux * factor))
            case Convection(coefficient=each, ambient=ambient):
                weights = surface.areas * each
                fluids.append(HeatExchange(jump=surface.points, conductances=weights, ambient=ambient * factor))
    links, free = _linked((*model.exchanges, *fluids), model.n_nodes), model.free_nodes()
    factor_of_mean = strain.moduli.free.coefficient * (stage.span * strain.rates[0])
    corrections, moved, values, mean, flow, middle = balanced(
        end, before.temperature, model.capacity, factor_of_mean, strain.inert, _rows(model.conduction),
        links, given, stage.span, stage.theta, free, MOVING, floor,
    )  # fmt: skip
    left = float(np.abs(values[free]).sum())
    if corrections < 0 or not left <= MOVING * moved + floor:
        return None
    for fluid in fluids:  # the heat of loads is counted apart
        flow -= fluid.jump.T @ fluid.heat(middle)
    after = heat_values(model, end)
    return Balance(after=after, values=values, moved=moved, matrix=None, mean=middle, flow=flow,
                   strain=strain.at(stage.span, before, after, mean))  # fmt: skip


def _rows(matrix: sp.csr_array) -> tuple[NDArray[np.uint32], NDArray[np.uint32], Array]:
    """Pointers of the rows, columns and values of a matrix; unsigned: no wrap-around of negative indices."""
    indptr, indices = (index.astype(np.int32, copy=False).view(np.uint32) for index in (matrix.indptr, matrix.indices))
    return indptr, indices, matrix.data


def _linked(links: Sequence[HeatExchange], n: int) -> tuple[Array | NDArray[np.uint32], ...]:
    """Rows of all differences of ``n`` temperatures and of their transpose, weights and opposite temperatures."""
    if not links:
        none, pointers, few = np.zeros(0), np.zeros(n + 1, np.uint32), np.zeros(0, np.uint32)
        return np.zeros(1, np.uint32), few, none, pointers, few, none, none, none
    jump = links[0].jump if len(links) == 1 else sp.csr_array(sp.vstack([link.jump for link in links], format="csr"))
    ambient = np.concatenate([np.broadcast_to(link.ambient, link.conductances.shape) for link in links]).astype(float)
    weights = np.concatenate([link.conductances for link in links])
    return *_rows(jump), *_rows(sp.csr_array(jump.T)), weights, ambient
