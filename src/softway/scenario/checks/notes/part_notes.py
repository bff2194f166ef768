"""Notes on a scenario: meshes, cells, contacts and ties that are computed, although their results may be wrong."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid, free_components
from softway.bodies.inertia.mass_matrix import Consistent, nodal_mass
from softway.bodies.solid import Solid
from softway.contact.assembly.tie import Tie
from softway.contact.contact import Contact, NodeToSurface
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.sagitta import Misfit, NodalCurvature, misfit, nodal_curvature
from softway.errors import Note, within
from softway.laws.cohesive_law import BilinearCohesive
from softway.meshes.files.listed_mesh import LeftOut
from softway.meshes.flaws.examination import examined
from softway.model.model import Model
from softway.scenario.checks.locking import locking_notes
from softway.scenario.checks.names import mesh_of
from softway.scenario.checks.notes.tool_notes import tool_curvature

SHARE = 0.1
"""Distance of facets from the smooth surface, relative to the gap or interference, beyond which it is noted."""
ROUNDING = 1e-6
"""Distance of facets from the smooth surface, relative to the shortest edge, below which it is rounding."""
ALIKE = 5e-4
"""Relative difference of moments of inertia that is not worth a word."""


def file_notes(left_out: Mapping[str, Sequence[LeftOut]]) -> tuple[Note, ...]:
    """Notes on the mesh files by body: one that lists the cards that are not honoured.

    Headings, output requests and markers are added in one line, and make no note alone.

    Examples
    --------
    >>> fixed = LeftOut(card="*BOUNDARY", count=1, lines=("7",))
    >>> head = LeftOut(card="*HEADING", count=1, lines=("1",), matters=False)
    >>> print(file_notes({"bar": (fixed, head)})[0].problem)
    its file has cards that are not honoured:
        *BOUNDARY (1; line 7)
        without meaning for the mesh: *HEADING
    """
    notes = []
    for name, cards in left_out.items():
        lines = [str(card) for card in cards if card.matters]
        quiet = ", ".join(f"{c.card} ({c.count})" if c.count > 1 else c.card for c in cards if not c.matters)
        if lines:
            lines += [f"without meaning for the mesh: {quiet}"] if quiet else []
            problem = "\n    ".join(["its file has cards that are not honoured:", *lines])
            remedy = "say in the scenario what they mean, such as material, supports and loads; --strict refuses them"
            notes.append(Note(where=f"bodies.{name}.mesh", problem=problem, remedy=remedy))
    return tuple(notes)


def body_notes(solids: Mapping[str, Solid], ties: Sequence[Tie] = ()) -> tuple[Note, ...]:
    """Notes on the meshes of the solids by name.

    Raises
    ------
    InputError
        For a mesh whose cells overlap, or with a node that hangs on a facet.
    """
    notes: list[Note] = []
    for name, solid in solids.items():
        with within(f"bodies.{name}.mesh"):
            found = examined(mesh_of(solid), [tie.tags for tie in ties if tie.bodies == (name, name)])
        notes += [note.within(f"bodies.{name}") for note in found]
    return _told_once(notes)


def _told_once(notes: Sequence[Note]) -> tuple[Note, ...]:
    """Notes on bodies, of which equal ones on several bodies are one note, with the names of the others."""
    found: dict[tuple[str, ...], list[Note]] = {}
    for note in notes:
        _, _, *rest = note.where.split(".")
        found.setdefault((*rest, note.problem, note.remedy), []).append(note)
    return tuple(_with_names(first, [note.where.split(".")[1] for note in others]) for first, *others in found.values())


def _with_names(note: Note, others: Sequence[str]) -> Note:
    """Note whose problem names the other bodies of which it holds."""
    if not others:
        return note
    also = f"{', '.join(others[:-1])} and {others[-1]}" if len(others) > 1 else others[0]
    return replace(note, problem=f"{note.problem} (also {also})")


def cell_notes(model: Model) -> tuple[Note, ...]:
    """Notes on the cells of the solids as they are computed."""
    notes: list[Note] = []
    for name, solid in model.scene.bodies.items():
        if isinstance(solid, Solid):
            fixed = ~free_components(solid.supports, mesh_of(solid))
            notes += [note.within(f"bodies.{name}") for note in locking_notes(solid, fixed)]
    return _told_once(notes)


def wall_notes(model: Model, solids: Mapping[str, Solid]) -> tuple[Note, ...]:
    """Notes on solids of the scenario with walls one cell thick, which the model has in two layers."""
    notes = []
    for part in model.parts:
        given, found = mesh_of(solids[part.name]), model.adapted.get(part.name)
        mesh = part.mesh if found is None else found.base
        more = mesh.n_nodes - given.n_nodes
        if more:
            ratio, shift = _changes(model, part)
            problem = (
                f"walls one cell thick that may touch: {more} more nodes at half their thickness carry the mass of "
                f"their faces; the body is computed and recorded with {mesh.n_cells} cells in place of "
                f"{given.n_cells}"
            )
            if abs(ratio - 1.0) > ALIKE:
                problem += f", and its moments of inertia are {ratio:.3g} times those of the body"
            if shift > ROUNDING * given.edge():
                problem += f", its centre of mass {shift:.2g} m away"
            remedy = "nothing, if this is meant; or two layers of cells there, or quadratic cells"
            notes.append(Note(where=f"bodies.{part.name}.mesh", problem=problem, remedy=remedy))
    return tuple(notes)


def _changes(model: Model, part: DiscreteSolid) -> tuple[float, float]:
    """Least ratio of a moment of inertia of the model to that of the mesh, for a body of the same mass, and the
    distance of their centres of mass [m].
    """
    solid, x = model.scene.bodies[part.name], part.mesh.points
    rule = solid.mass if isinstance(solid, Solid) else Consistent()
    plain = nodal_mass(part.mesh, part.materials.density, part.internal.section, rule)
    (one, found), (other, exact) = (_inertia(mass, x) for mass in (model.mass[part.nodes, part.nodes], plain))
    ratio = float(np.linalg.eigvals(np.linalg.solve(exact, found)).real.min())
    return ratio, float(np.linalg.norm(one - other))


def _inertia(mass: csr_array, points: Array) -> tuple[Array, Array]:
    """Centre (d,) [m], and moments of inertia about it for each unit of mass: (3, 3), in the plane (1, 1) [m^2]."""
    nodal = np.asarray(mass.sum(axis=1)).ravel()
    centre = nodal @ points / nodal.sum()
    second = (points - centre).T @ (mass @ (points - centre)) / nodal.sum()
    polar = np.trace(second)
    return centre, polar * np.eye(3) - second if len(second) == 3 else np.array([[polar]])


def contact_notes(model: Model) -> tuple[Note, ...]:
    """Notes on contacts of curved surfaces whose facets stand off the curve as far as the gap or interference is.

    Against a tool only the nodes of the solid count, and the facets of the tool. Mortar contact measures gaps on the
    curve itself.
    """
    notes, curvature = [], partial(_curvature, model)
    for k, contact in enumerate(model.scene.contacts):
        tool = model.tools.get(contact.opponent) if model.against_tool[k] else None
        second = None if tool is None else tool_curvature(tool)
        nodes = tool is not None or contact.many or isinstance(contact.method, NodeToSurface)
        mortar = contact.timing.massless and not nodes
        if model.shape[1] == 1 or mortar or (tool is not None and second is None):
            continue
        surfaces = [curvature(*place) for place in _surfaces(model, contact)]
        if second is not None:
            surfaces = [replace(surfaces[0], factor=0.0), second]
        fit = contact.start == "fit"
        found = _worst(misfit(one, other, fit) for one, other in combinations(surfaces, 2))
        least = ROUNDING * min(float(model.edge[model.parts[n].nodes].min()) for n in model.contact_solids[k])
        if found is not None and found.off > max(least, SHARE * abs(found.gap)):
            notes.append(_off(model.declared[k], contact, found, tool is not None))
    return tuple(notes)


def tie_notes(model: Model) -> tuple[Note, ...]:
    """Notes on ties whose nodes have no inertia inside the glue, as meshes that do not match couple them with its rim.

    Nodes at the places of others that may touch are partners at the rim, which lose theirs on matching meshes, too.
    """
    if not model.inert or not len(model.touchable):
        return ()
    notes, numbers = [], {p.name: k for k, p in enumerate(model.parts)}
    light = ~model.massive
    light[model.touchable] = False
    touching = cKDTree(model.points[model.touchable])
    for k, tie in enumerate(model.scene.ties):
        parts = [model.parts[numbers[name]] for name in tie.bodies]
        nodes = np.concatenate([p.mesh.nodes(tag) + p.nodes.start for p, tag in zip(parts, tie.tags, strict=True)])
        inner = nodes[light[nodes]]
        count = int((touching.query(model.points[inner])[0] > ROUNDING * model.edge[inner]).sum())
        if count:
            problem = (
                f"{count} of the {len(nodes)} nodes in the glue have no inertia, as they move with nodes of its rim "
            )
            problem += "that may touch: waves are reflected there"
            remedy = "matching meshes at the rim, or tags of the contacts that leave out its rim"
            notes.append(Note(where=f"ties[{k}].between", problem=problem, remedy=remedy))
    return tuple(notes)


def cohesion_notes(model: Model) -> tuple[Note, ...]:
    """Notes on ties that break whose cells are longer than a third of the zone in which the glue softens, and on those
    whose surfaces have no contact after the break.
    """
    notes = []
    met = [set(solids) for solids in model.contact_solids]
    numbers = {p.name: k for k, p in enumerate(model.parts)}
    for tie in (tie for bond in model.bonds for tie in bond.ties):
        where, parts = f"ties[{tie.number}].breaks", {numbers[name] for name in tie.tie.bodies}
        zone = min(_zone(model.parts[k], tie.law) for k in parts)
        edge = float(model.edge[tie.jump.node].max())
        if model.shape[1] > 1 and 3.0 * edge > zone:
            problem = f"cells of {edge:.3g} m, where the glue softens over about {zone:.3g} m: it breaks in jumps"
            notes.append(Note(where=where, problem=problem, remedy=f"cells of {zone / 3.0:.2g} m, or a lower strength"))
        if not any(parts <= solids for solids in met):
            problem = "no contact of the two: after the break they are pushed apart only by the nodes glued before"
            remedy = f"a contact between {list(tie.tie.between)}, or nothing where they do not meet again"
            notes.append(Note(where=where, problem=problem, remedy=remedy))
    return tuple(notes)


def _zone(part: DiscreteSolid, law: BilinearCohesive) -> float:
    """Length of the zone in which glue on a solid softens [m], ``modulus energy / strength^2`` of the shorter mode."""
    density, speed = part.materials.stiffest(part.internal.section)
    return min(density * speed**2 * energy / strength**2 for strength, energy in (law.opening, law.sliding))


def _surfaces(model: Model, contact: Contact) -> list[tuple[int, str]]:
    """Number of the solid and tag of each surface of a contact."""
    numbers = {p.name: k for k, p in enumerate(model.parts)}
    return [(numbers[name], tag) for name, tag in contact.surfaces if name in numbers]


def _worst(found: Iterable[Misfit | None]) -> Misfit | None:
    """Misfit that is greatest relative to its gap; None if no surfaces meet."""
    return max((f for f in found if f is not None), key=lambda f: f.off / max(abs(f.gap), f.off, 1e-300), default=None)


def _curvature(model: Model, number: int, tag: str) -> NodalCurvature:
    """Curvature of a surface of a solid at the initial displacement."""
    part = model.parts[number]
    facets = {name: nodes + part.nodes.start for name, nodes in part.mesh.facets_on(tag).items()}
    return nodal_curvature(ContactSurface(facets=facets), model.points + model.displacement)


_OTHERWISE = {
    (True, False): "smooth = true for a shape without sharp edges",
    (False, False): "method = DualMortar, which measures gaps on the curves",
    (False, True): "a contact of these two surfaces of its own, with mortar gaps on the curves",
}
"""What to do about facets off the curve, by whether a tool and whether many surfaces are in the contact."""


def _off(k: int, contact: Contact, found: Misfit, tool: bool) -> Note:
    """Note on facets that stand off the curve through their nodes, those of a tool or of two solids."""
    share = f" ({found.off / abs(found.gap):.0%} of it)" if found.gap else ""
    what = f"the interference is {-found.gap:.3g} m" if contact.start == "fit" else f"the gap is {found.gap:.3g} m"
    whose = f"the tool {contact.opponent!r}" if tool else " and ".join(map(repr, dict.fromkeys(contact.names)))
    problem = (
        f"the facets of {whose} stand up to {found.off:.3g} m off the curves through their "
        f"nodes, and {what}{share}: pressures may be wrong by this share, and more from node to node"
    )
    shorter = "shorter edges: half the edge leaves a quarter of the distance"
    otherwise = (
        _OTHERWISE[tool, contact.many] if contact.timing.massless or tool else "the same nodes along both surfaces"
    )
    remedy = f"{otherwise}, or {shorter}"
    return Note(where=f"contacts[{k}].between", problem=problem, remedy=remedy)
