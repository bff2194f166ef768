"""Overlap of bodies at the start: nodes inside another body or inside a tool."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.contact.contact_rows import ContactRows
from softway.contact.surfaces.boundary import ContactSurface
from softway.errors import within
from softway.meshes.cells import FLAT
from softway.model.model import Model
from softway.obstacles.triangulated import Facets

CHORD = 0.02
"""Admissible distance between flat simplices and curved facets, in edges at the node."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlap:
    """Deepest node of a contact: its ``depth`` [m], its ``body``, and the opponent ``other``."""

    contact: int
    depth: float
    body: str
    other: str
    node: int
    place: tuple[float, ...]


def deepest(model: Model, u: Array, rounding: float, start: Literal["apart", "fit"] = "apart") -> Overlap | None:
    """Deepest overlap of contacts with this ``start``, at the displacement ``u`` (n, d); None without overlap."""
    found = []
    tools = any(c.start == start and t for c, t in zip(model.scene.contacts, model.against_tool, strict=True))
    rows = model.rows(u) if tools else None
    for k, contact in enumerate(model.scene.contacts):
        if contact.start != start:
            continue
        if rows is not None and model.against_tool[k]:
            found.append(_in_tool(model, u, k, rows, rounding))
            continue
        solids = model.contact_solids[k]
        for outer in reversed(solids) if len(solids) > 1 else ():
            distance = _distance_from(model, u, outer)
            found += [_in_body(model, u, k, (inner, outer), distance, rounding) for inner in solids if inner != outer]
    deep = [f for f in found if f is not None]
    return max(deep, key=lambda f: f.depth) if deep else None


def shrunk(model: Model, u: Array, rounding: float) -> Array:
    """Displacement (n, d) with the surfaces of the first bodies of press fits moved inward until nothing overlaps.

    On the path from there to ``u`` the surfaces touch from outside, for any depth of overlap.
    """
    found = deepest(model, u, rounding, "fit")
    out = u.copy()
    if found is None:
        return out
    first = {c.body for c in model.scene.contacts if c.start == "fit"}
    for part in (p for p in model.parts if p.name in first):
        nodes = _candidates(model, part)
        out[nodes] -= 1.1 * found.depth * _outward(part, (model.points + u)[part.nodes])[nodes - part.nodes.start]
    return out


def _outward(part: DiscreteSolid, x: Array) -> Array:
    """Unit outward normals (n, d) at the boundary nodes of a solid whose nodes are at ``x`` (n, d)."""
    if x.shape[1] == 1:
        return np.sign(x - x.mean(axis=0))
    side = ContactSurface(facets=part.mesh.boundary())
    out = np.zeros_like(x)
    out[side.nodes] = side.nodal_normals(x)
    return out


def _in_tool(model: Model, u: Array, k: int, rows: ContactRows, rounding: float) -> Overlap | None:
    """Deepest node of a contact in its tool, from all contact ``rows`` at the displacement ``u`` (n, d)."""
    here = np.flatnonzero(rows.of_contact(k))
    gap = rows.gap(u)[here]
    if not len(gap) or gap.min() >= -rounding:
        return None
    node = int(rows.node[here[int(np.argmin(gap))]])
    return _named(model, u, k, node, -float(gap.min()), model.scene.contacts[k].opponent)


def _in_body(
    model: Model, u: Array, k: int, pair: tuple[int, int], distance: Callable[[Array], Array], rounding: float
) -> Overlap | None:
    """Deepest contact node of the first solid of a pair inside the second, by the ``distance`` from its boundary."""
    inner, outer = (model.parts[n] for n in pair)
    nodes = _candidates(model, inner)
    x = model.points + u
    walls = x[outer.nodes]
    nodes = nodes[((x[nodes] >= walls.min(axis=0)) & (x[nodes] <= walls.max(axis=0))).all(axis=1)]
    if not len(nodes):
        return None
    gap = distance(x[nodes])
    slack = rounding + (CHORD * model.edge[nodes] if _curved(outer) else 0.0)
    depth = np.where(gap < -slack, -gap, 0.0)
    if not depth.any():
        return None
    worst = int(np.argmax(depth))
    return _named(model, u, k, int(nodes[worst]), float(depth[worst]), outer.name)


def _candidates(model: Model, part: DiscreteSolid) -> IntArray:
    """Contact nodes (k,) of a solid."""
    found: IntArray = model.touchable[(model.touchable >= part.nodes.start) & (model.touchable < part.nodes.stop)]
    return found


def _distance_from(model: Model, u: Array, number: int) -> Callable[[Array], Array]:
    """Distance (p,) of points (p, d) from the boundary of a solid at the displacement ``u`` (n, d); negative inside."""
    part = model.parts[number]
    corners = (model.points + u)[part.nodes]
    if corners.shape[1] == 1:
        low, high = float(corners.min()), float(corners.max())
        return lambda x: np.maximum(low - x[:, 0], x[:, 0] - high)
    boundary = part.mesh.boundary()
    cells: list[IntArray] = [f[:, list(s)] for name, f in boundary.items() for s in FLAT.get(name, ())]
    if cells:
        with within(f"bodies.{part.name}.mesh"):
            surface = Facets(points=corners, cells=np.concatenate(cells))
        if surface.closed:
            return surface.gap
    return lambda x: np.full(len(x), np.inf)


def _curved(part: DiscreteSolid) -> bool:
    return any(len(FLAT.get(name, ())) > 1 for name in part.mesh.boundary())


def _named(model: Model, u: Array, k: int, node: int, depth: float, other: str) -> Overlap:
    part = model.parts[model.part_of[node]]
    place = tuple(float(v) for v in model.points[node] + u[node])
    return Overlap(contact=k, depth=depth, body=part.name, other=other, node=node - part.nodes.start, place=place)
