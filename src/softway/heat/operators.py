"""Heat content of the nodes, heat flow between them, and heat exchange at surfaces, with their derivatives."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray
from softway.bodies.elements.cut_cells import melted_part
from softway.bodies.elements.following_heat import Entries, combined
from softway.bodies.setup.heat_loads import Convection, HeatFlux, Radiation
from softway.heat.heat_model import HeatCells, HeatModel, HeatSurface
from softway.laws.heat.contact_heat import STEFAN_BOLTZMANN
from softway.laws.heat.heat_content import ZERO, ContentCurve


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatValues:
    """Temperatures and contents of n nodes and E cells at one instant.

    Parameters
    ----------
    unknowns
        (n,) temperatures [K], above melting where cells melt, or specific contents [J/kg] where latent heat is at
        the nodes.
    temperature, stretch
        (n,) temperatures [K], and their derivatives along the unknowns.
    content
        (n,) heat contents [J].
    capacity
        (n,) derivative of the contents along the unknowns of the same nodes, without latent heat in cut cells.
    latent_slope
        Entries of the derivative (n, n) of that latent heat along the temperatures [J/K].
    liquid
        (E,) share of the cells that conducts like the liquid.
    liquid_slope
        Entries of its derivative (E, n) along the unknowns.
    melted
        (E,) share of the cells that has taken latent heat.
    share, share_slope
        (n,) share of the latent heat of the nodes that they have taken, and its derivative along the unknowns of the
        same nodes where latent heat is at the nodes.
    """

    unknowns: Array
    temperature: Array
    stretch: Array
    content: Array
    capacity: Array
    latent_slope: Entries
    liquid: Array
    liquid_slope: Entries
    melted: Array
    share: Array
    share_slope: Array


def unknowns_of(model: HeatModel, temperature: Array) -> Array:
    """Unknowns (n,) of temperatures (n,) [K]: matter at melting is solid."""
    out = temperature.copy()
    for part in model.parts:
        here = part.nodes
        out[here] = part.curve.content(temperature[here]) if part.at_nodes else temperature[here] - part.zero
    return out


def heat_values(model: HeatModel, unknowns: Array, slopes: bool = True) -> HeatValues:
    """Temperatures and contents of given unknowns (n,); without ``slopes`` the derivatives with entries are empty."""
    n = model.n_nodes
    if model.capacity is not None:
        none: Array = np.zeros(model.n_cells)
        return HeatValues(
            unknowns=unknowns, temperature=unknowns, stretch=np.ones(n), content=model.capacity * (unknowns - ZERO),
            capacity=model.capacity, latent_slope=(), liquid=none, liquid_slope=(), melted=none,
            share=np.zeros(n), share_slope=np.zeros(n),
        )  # fmt: skip
    temperature, stretch, over = np.empty(n), np.ones(n), unknowns.copy()
    content, capacity, share, share_slope = np.empty(n), np.empty(n), np.zeros(n), np.zeros(n)
    rigid = slice(n - len(model.lumps), n)
    temperature[rigid], content[rigid], capacity[rigid] = unknowns[rigid], unknowns[rigid] - ZERO, 1.0
    for part in model.parts:
        here, x = part.nodes, unknowns[part.nodes]
        if part.at_nodes and isinstance(part.curve, ContentCurve):
            temperature[here], stretch[here] = part.curve.temperature(x)
            content[here], capacity[here] = x, 1.0
            share[here], share_slope[here] = part.curve.liquid_share(x, temperature[here])
            over[here] = temperature[here] - part.zero
        else:
            temperature[here] = x + part.zero
            content[here] = part.curve.content(temperature[here])
            capacity[here] = part.curve.capacity(temperature[here])
    melted = _mean_shares(model, share)
    liquid, latent, cut_slope, latent_slope = _cut(model, over, slopes)
    mixed = np.zeros(model.n_cells, dtype=bool)
    for part in model.parts:
        mixed[part.cells] = part.mixed
        if not part.at_nodes:
            melted[part.cells] = liquid[part.cells]
    liquid[mixed] = melted[mixed]
    slope = tuple((rows, columns, values * stretch[columns]) for rows, columns, values in cut_slope)
    if slopes and mixed.any():
        slope = (*slope, *_mean_slopes(model, mixed, share_slope))
    return HeatValues(
        unknowns=unknowns, temperature=temperature, stretch=stretch, content=model.mass * content + latent,
        capacity=model.mass * capacity, latent_slope=latent_slope, liquid=liquid, liquid_slope=slope, melted=melted,
        share=share + latent / np.where(model.latent > 0.0, model.latent, np.inf), share_slope=share_slope,
    )  # fmt: skip


def _cut(model: HeatModel, over: Array, slopes: bool) -> tuple[Array, Array, Entries, Entries]:
    """Share (E,) of the cells above melting, the latent heat (n,) of that part [J], and their derivatives."""
    over, E = model.held_by(over), model.n_cells
    n = len(over)
    liquid, latent = np.zeros(E), np.zeros(n)
    slope, latent_slope = [], []
    for block in model.simplices:
        part, grown = melted_part(over[block.nodes], block.width)
        liquid += np.bincount(block.numbers, block.share * part.sum(axis=1), E)
        heat = block.heat * block.mass
        latent += np.bincount(block.nodes.ravel(), (heat[:, None] * part).ravel(), n)
        cut = np.flatnonzero(grown.any(axis=(1, 2)))
        if not slopes or not cut.size:
            continue
        nodes, k = block.nodes[cut], block.nodes.shape[1]
        columns = (block.share[cut, None] * grown[cut].sum(axis=1)).ravel()
        slope.append((np.repeat(block.numbers[cut], k), nodes.ravel(), columns))
        if block.heat:
            both = np.repeat(nodes, k, axis=1).ravel(), np.tile(nodes, (1, k)).ravel()
            latent_slope.append((*both, (heat[cut, None, None] * grown[cut]).ravel()))
    if model.hanging is None:
        return liquid, latent, tuple(slope), tuple(latent_slope)
    spread = model.hanging.spread
    by = combined(sp.eye_array(E, format="csr"), tuple(slope), (E, n), spread)
    return liquid, model.owned(latent), by, combined(spread, tuple(latent_slope), (n, n), spread)


def _mean_shares(model: HeatModel, share: Array) -> Array:
    """Mean liquid shares (E,) of the nodes of the cells, from those of the nodes (n,)."""
    liquid, share = np.zeros(model.n_cells), model.held_by(share)
    for cells in (c for c in model.cells if c.law.latent is not None):
        liquid[cells.numbers] = share[cells.nodes].mean(axis=1)
    return liquid


def _mean_slopes(model: HeatModel, mixed: BoolArray, slope: Array) -> Entries:
    """Derivative (E, n) of the mean shares of the ``mixed`` cells (E,), from those of the nodes (n,)."""
    chosen = ((c.nodes, c.numbers) for c in model.cells if mixed[c.numbers].any())
    found = tuple((np.repeat(e, n.shape[1]), n.ravel(), np.full(n.size, 1.0 / n.shape[1])) for n, e in chosen)
    if model.hanging is not None:
        E, spread = model.n_cells, model.hanging.spread
        found = combined(sp.eye_array(E, format="csr"), found, (E, spread.shape[0]), spread)
    return tuple((rows, columns, values * slope[columns]) for rows, columns, values in found)


def heat_flow(
    model: HeatModel, temperature: Array, liquid: Array, slopes: bool
) -> tuple[Array, sp.csr_array | None, Entries]:
    """Heat (n,) that flows out of the nodes by conduction [W], and its derivatives.

    Parameters
    ----------
    model
        Model.
    temperature, liquid
        (n,) temperatures [K], and (E,) liquid shares of the cells.
    slopes
        False to leave the derivatives out.

    Returns
    -------
    flow
        (n,) [W]; its sum is zero.
    by_temperature, by_liquid
        (n, n) derivative along the temperatures [W/K], and entries of that (n, E) along the liquid shares [W]; None
        and empty if left out.
    """
    if model.conduction is not None:
        # from the temperature of a node of each body: a uniform one conducts nothing, not even its rounding
        over = temperature - (temperature[:1] if len(model.parts) == 1 else 0.0)
        for part in model.parts if len(model.parts) > 1 else ():
            over[part.nodes] -= temperature[part.nodes.start]
        over[len(temperature) - len(model.lumps) :] = 0.0
        return model.conduction @ over, model.conduction if slopes else None, ()
    temperature, hanging = model.everywhere(temperature), model.hanging
    flow = np.zeros(len(temperature))
    blocks: list[Array] = []
    columns = []
    for cells in model.cells:
        at = temperature[cells.nodes]
        k, by_k, by_share = _conductivity(cells, at @ cells.N.T, liquid[cells.numbers])
        falls = np.einsum("eqar,ea->eqr", cells.gradients, at)
        weight = cells.volume[..., None]
        np.add.at(flow, cells.nodes, np.einsum("eqar,eqr->ea", cells.gradients, weight * k * falls))
        if not slopes:
            continue
        block = np.einsum("eqar,eqr,eqbr->eab", cells.gradients, weight * k, cells.gradients, optimize=True)
        if not cells.law.constant:
            turned = np.einsum("eqar,eqr->eqa", cells.gradients, weight * by_k * falls)
            block = block + np.einsum("eqa,qb->eab", turned, cells.N)
        if cells.law.latent is not None:
            column = np.einsum("eqar,eqr->ea", cells.gradients, weight * by_share * falls)
            columns.append((cells.nodes.ravel(), np.repeat(cells.numbers, cells.nodes.shape[1]), column.ravel()))
        blocks.append(block[..., None, None])
    whole = flow if hanging is None else np.asarray(hanging.follow.T @ flow)
    if not slopes:
        return whole, None, ()
    found = model.pattern.assemble(blocks)
    matrix = sp.csr_array((found.data, found.indices, found.indptr), shape=found.shape)
    if hanging is None:
        return whole, matrix, tuple(columns)
    shape = len(flow), model.n_cells
    return whole, hanging.matrix(matrix), combined(hanging.follow, tuple(columns), shape, None)


def entropy(model: HeatModel, now: HeatValues) -> float:
    """Entropy of all conductors [J/K], counted from a temperature of each law; latent heat is that at melting."""
    total = 0.0
    for part in model.parts:
        here = part.nodes
        mass, temperature = model.mass[here], now.temperature[here]
        total += float(mass @ part.curve.entropy(temperature))
        if part.law.latent is None:
            continue
        if part.at_nodes and isinstance(part.curve, ContentCurve):
            share = part.curve.liquid_share(now.unknowns[here], temperature)[0] if not part.curve.half_range else 0.0
            latent = float((mass * share).sum()) * part.curve.heat
        else:
            latent = float((now.content[here] - mass * part.curve.content(temperature)).sum())
        total += latent / part.law.latent.melting
    return total


def liquid_volumes(model: HeatModel, now: HeatValues) -> dict[str, float]:
    """Volume of the liquid of each body that melts [m^3]."""
    melting = (part for part in model.parts if part.law.latent is not None)
    return {part.name: float(part.volume @ now.melted[part.cells]) for part in melting}


def rigid_temperatures(model: HeatModel, now: HeatValues) -> dict[str, float]:
    """Temperature of each rigid body [K]."""
    first = model.n_nodes - len(model.lumps)
    return {lump.name: float(now.temperature[k]) for k, lump in enumerate(model.lumps, first)}


def heat_flux(model: HeatModel, now: HeatValues) -> Array:
    """Mean heat fluxes (E, 3) of the cells [W/m^2]; zero along axes that the mesh has not."""
    out, temperature = np.zeros((model.n_cells, 3)), model.everywhere(now.temperature)
    for cells in model.cells:
        at = temperature[cells.nodes]
        k, _, _ = _conductivity(cells, at @ cells.N.T, now.liquid[cells.numbers])
        flux = -k * np.einsum("eqar,ea->eqr", cells.gradients, at)
        mean = np.einsum("eq,eqr->er", cells.volume, flux) / cells.volume.sum(axis=1)[:, None]
        out[cells.numbers, : mean.shape[1]] = mean
    return out


def cell_values(model: HeatModel, body: str, now: HeatValues) -> dict[str, Array]:
    """Heat fluxes (e, 3) [W/m^2] in the cells of a body, and liquid shares (e,) if it melts; empty without heat."""
    out: dict[str, Array] = {}
    for part in model.parts:
        if part.name == body:
            out["heat_flux"] = heat_flux(model, now)[part.cells]
            if part.law.latent is not None:
                out["liquid"] = now.melted[part.cells]
    return out


def _conductivity(cells: HeatCells, temperature: Array, liquid: Array) -> tuple[Array, Array, Array]:
    """Conductivities (e, q, r), and their derivatives along the temperature and the liquid share of the cells."""
    r = cells.gradients.shape[-1]
    solid, by_solid = cells.law.along_axes(temperature, r)
    if cells.law.latent is None or cells.law.liquid is cells.law:
        return solid, by_solid, np.zeros_like(solid)
    molten, by_molten = cells.law.liquid.along_axes(temperature, r)
    share = liquid[:, None, None]
    return solid + share * (molten - solid), by_solid + share * (by_molten - by_solid), molten - solid


def surface_heat(surface: HeatSurface, temperature: Array, factor: float) -> tuple[Array, Array]:
    """Heat (p,) into a body at the points of a surface [W], and its derivative along their temperatures [W/K].

    Parameters
    ----------
    surface, temperature
        Surface, and (n,) temperatures [K].
    factor
        Mean factor of the load.
    """
    load, areas = surface.load, surface.areas
    match load:
        case HeatFlux():
            return areas * load.value * factor, np.zeros_like(areas)
        case Convection():
            at = surface.points @ temperature
            return areas * load.coefficient * (load.ambient * factor - at), -areas * load.coefficient
        case Radiation():
            at = surface.points @ temperature
            scale = areas * load.emissivity * STEFAN_BOLTZMANN
            return scale * ((load.ambient * factor) ** 4 - at**4), -4.0 * scale * at**3
