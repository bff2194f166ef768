"""Internal force of a body from its materials."""

import numpy as np

from softway.arrays import IntArray
from softway.bodies.elements.quadrature import Dilating, sampled_cells
from softway.bodies.elements.section import Section
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.elastic.elastic_force import elastic_force
from softway.bodies.internal_force.inelastic.inelastic_force import inelastic_force
from softway.bodies.internal_force.materials import Materials
from softway.bodies.internal_force.regions import RegionForces, Term, joined
from softway.laws.law import Material, RateLaw
from softway.meshes.mesh import Mesh


def internal_force(mesh: Mesh, materials: Materials, section: Section, dilatation: Dilating) -> BodyForce:
    """Build the internal force of a body: of one law, or the sum over the regions.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.bodies.internal_force.materials import materials_of
    >>> from softway.laws.bulk import LinearElastic
    >>> from softway.meshes.generators.shapes import interval
    >>> bar = interval(2.0, cells=2).with_region("a", lambda x: x[:, 0] < 1.0).with_region("b", lambda x: x[:, 0] > 1.0)
    >>> materials = materials_of(bar, {"a": LinearElastic(E=1.0), "b": LinearElastic(E=2.0)}, 1.0)
    >>> force = internal_force(bar, materials, Bar(), "point")
    >>> force.tangent(np.zeros((3, 1))).toarray().round(12).tolist()
    [[1.0, -1.0, 0.0], [-1.0, 3.0, -2.0], [0.0, -2.0, 2.0]]
    """
    if materials.owner is None:
        return force_of(mesh, materials.laws[0], section, dilatation)
    return _region_forces(mesh, materials, materials.owner, section, dilatation)


def force_of(mesh: Mesh, material: Material, section: Section, dilatation: Dilating) -> BodyForce:
    """Build the internal force of a body for one material law."""
    if isinstance(material, RateLaw):
        return inelastic_force(mesh, material, section, dilatation)
    return elastic_force(mesh, material, section, dilatation)


def _region_forces(
    mesh: Mesh, materials: Materials, owner: IntArray, section: Section, dilatation: Dilating
) -> RegionForces:
    """Sum of the forces of the regions; a region without elements has none."""
    whole = sampled_cells(mesh, section, "point", small=False)
    points = _points(whole.sampling.rows)
    terms = []
    for number, (name, law) in enumerate(zip(materials.regions, materials.laws, strict=True)):
        mine = owner == number
        if mine.any():
            nodes, own = _submesh(mesh, mine)
            term = Term(
                region=name,
                number=number,
                nodes=nodes,
                cells=np.flatnonzero(mine),
                points=np.flatnonzero(mine[points]),
                entries=np.zeros(0, int),
                internal=force_of(own, law, section, dilatation),
            )
            terms.append(term)
    return joined(terms, whole, (mesh.n_nodes, mesh.dim))


def _points(rows: tuple[np.ndarray, ...]) -> IntArray:
    """Number (p,) of the element of each quadrature point."""
    per_cell = np.concatenate([np.full(len(table), table.shape[1]) for table in rows])
    return np.repeat(np.arange(len(per_cell)), per_cell)


def _submesh(mesh: Mesh, chosen: np.ndarray) -> tuple[IntArray, Mesh]:
    """Nodes (k,) of the chosen elements (e,), and their mesh."""
    kept, start = {}, 0
    for kind, cells in mesh.blocks.items():
        kept[kind] = cells[chosen[start : start + len(cells)]]
        start += len(cells)
    nodes = np.unique(np.concatenate([cells.ravel() for cells in kept.values()]))
    blocks = {kind: np.searchsorted(nodes, cells) for kind, cells in kept.items()}
    return nodes, Mesh(points=mesh.points[nodes], blocks=blocks)
