"""Solids, ties and contacts of a scene, with walls one cell thick in two layers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.assembled.thin_walls import Layered, layered
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.discretised import DiscreteSolid, discretise, driven_components
from softway.bodies.rigid_motion import RigidMotion, RigidShape
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.assemble import ContactAssembly, assemble_contacts
from softway.contact.assembly.tied_surfaces import tied_surfaces
from softway.errors import InputError, within
from softway.model.cohesive_ties import CohesiveTies, cohesive_ties
from softway.model.scene import Scene, StaticStart
from softway.model.ties import Glue, glued, joined, require_even


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layout:
    """Solids, ties and contacts of a scene.

    Parameters
    ----------
    scene
        Scene with the meshes of the model: its solids lie on each other where ties glue them.
    solids, parts
        The solids, as declared and as arrays.
    glue
        Nodes that follow others.
    bonds
        Ties that break.
    met
        Contacts.
    walls
        (w,) nodes at the ends of the edges across walls that have been divided.
    """

    scene: Scene
    solids: dict[str, Solid]
    parts: tuple[DiscreteSolid, ...]
    glue: Glue
    bonds: tuple[CohesiveTies, ...]
    met: ContactAssembly
    walls: IntArray

    @property
    def light(self) -> IntArray:
        """Nodes (k,) without inertia: those that may touch, those that ties move with them, and the faces of divided
        walls without the nodes that ties move with others.
        """
        return np.union1d(self.glue.together(self.met.nodes), np.setdiff1d(self.walls, self.glue.moving))


Known = Mapping[str, tuple[Solid, DiscreteSolid]]
"""Solids that are known as arrays."""


def laid_out(
    scene: Scene,
    motions: Mapping[str, RigidMotion],
    tools: Mapping[str, Tool | RigidShape],
    massless: bool,
    known: Known,
    slaves: Mapping[int, str],
) -> Layout:
    """Lay out a scene; if contact nodes are ``massless``, walls one cell thick that may touch are divided.

    The very same solids that are ``known`` keep their arrays, and ``slaves`` are solids that are those of contacts, by
    the number of the contact.

    Raises
    ------
    InputError
        If the scene has no solid, bodies do not fit, or a tag, tie or contact is wrong.
    """
    found = _laid_out(scene, motions, tools, known, slaves)
    if not massless:
        return found
    divided = {part.name: layered(part, found.solids[part.name], found.met.nodes) for part in found.parts}
    if not any(divided.values()):
        return found
    bodies = {**found.scene.bodies, **{name: one.solid for name, one in divided.items() if one is not None}}
    again = _laid_out(replace(found.scene, bodies=bodies), motions, tools, known, slaves)
    return replace(again, walls=_walls(again.parts, divided))


def _walls(parts: Sequence[DiscreteSolid], divided: Mapping[str, Layered | None]) -> IntArray:
    """Nodes (w,) of the model on the faces of divided walls."""
    found = [one.faces + p.nodes.start for p in parts if (one := divided[p.name]) is not None]
    return np.concatenate(found)


def _laid_out(
    scene: Scene,
    motions: Mapping[str, RigidMotion],
    tools: Mapping[str, Tool | RigidShape],
    known: Known,
    slaves: Mapping[int, str],
) -> Layout:
    """Solids, ties and contacts of a scene as it is."""
    solids = solids_of(scene)
    parts = _parts(solids, known)
    points = np.concatenate([p.mesh.points for p in parts])
    driven = driven_components(parts, solids, np.zeros_like(points), motions) if scene.ties else ()
    pairs = tied_surfaces(scene.ties, parts, points)
    require_even(pairs, parts)
    glue = glued([p for p in pairs if p.tie.breaks is None], joined([p.dofs for p in parts]), driven)
    breaking = [p for p in pairs if p.tie.breaks is not None]
    if breaking and isinstance(scene.start, StaticStart):
        raise InputError("start", "StaticStart with ties that break", 'start = "AsGiven", or ties without breaks')
    scene, solids, parts = _closed(scene, solids, parts, glue.closing(points, breaking))
    bonds = cohesive_ties(breaking, parts, np.concatenate([p.mesh.points for p in parts]))
    space = LocalSpace(tuple(p.nodes for p in parts))
    met = assemble_contacts(scene.contacts, {**solids, **tools}, parts, space, glue.joined, slaves)
    return Layout(scene=scene, solids=solids, parts=parts, glue=glue, bonds=bonds, met=met, walls=np.zeros(0, int))


def _closed(
    scene: Scene, solids: dict[str, Solid], parts: tuple[DiscreteSolid, ...], onto: Array
) -> tuple[Scene, dict[str, Solid], tuple[DiscreteSolid, ...]]:
    """Scene and its solids with their nodes at the places ``onto`` (n, d)."""
    points = np.concatenate([p.mesh.points for p in parts])
    if np.array_equal(onto, points):
        return scene, solids, parts
    moved = {}
    for part in parts:
        mesh = part.mesh
        if not np.array_equal(onto[part.nodes], points[part.nodes]):
            with within(f"bodies.{part.name}.mesh"):
                mesh = replace(mesh, points=onto[part.nodes])
        moved[part.name] = replace(solids[part.name], mesh=mesh, place=Placement(), group=())
    return replace(scene, bodies={**scene.bodies, **moved}), moved, _parts(moved, {})


def solids_of(scene: Scene) -> dict[str, Solid]:
    """Solids of a scene, at least one."""
    solids = {n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}
    if not solids:
        raise InputError("bodies", "no Solid among them", "at least one body of kind Solid")
    return solids


def _parts(solids: Mapping[str, Solid], known: Known) -> tuple[DiscreteSolid, ...]:
    """Arrays of the solids; those of the very same solid where it is known."""
    parts: list[DiscreteSolid] = []
    for name, solid in solids.items():
        first = parts[-1].nodes.stop if parts else 0
        if name in known and known[name][0] is solid:
            part = known[name][1]
            parts.append(replace(part, nodes=slice(first, first + part.mesh.n_nodes)))
            continue
        with within(f"bodies.{name}"):
            parts.append(discretise(name, solid, first))
    if len({p.mesh.dim for p in parts}) > 1:
        raise InputError("bodies", "solids of different space dimension in one scene", "meshes of one dimension")
    return tuple(parts)
