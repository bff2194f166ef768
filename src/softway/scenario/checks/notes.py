"""Notes on a scenario: meshes, cells and contacts that are computed, although their results may be wrong."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from softway.arrays import BoolArray
from softway.bodies.solid import Solid
from softway.contact.contact import Contact, NodeToSurface
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.sagitta import CurvedSurface, Misfit, curved_surface, misfit
from softway.errors import Note, within
from softway.meshes.examination import examined
from softway.meshes.files.listed_mesh import LeftOut
from softway.model.model import Model
from softway.scenario.checks.locking import locking_notes
from softway.scenario.checks.names import mesh_of
from softway.scenario.checks.tool_notes import curved_tool

SHARE = 0.1
"""Distance of facets from the smooth surface, relative to the gap or interference, beyond which it is noted."""
ROUNDING = 1e-6
"""Distance of facets from the smooth surface, relative to the shortest edge, below which it is rounding."""


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


def body_notes(solids: Mapping[str, Solid], fixed: Mapping[str, BoolArray]) -> tuple[Note, ...]:
    """Notes on the meshes and cells of the solids by name, whose components ``fixed`` (n, d) are supported.

    Raises
    ------
    InputError
        For a mesh whose cells overlap, or with a node that hangs on a facet.
    """
    notes: list[Note] = []
    for name, solid in solids.items():
        with within(f"bodies.{name}.mesh"):
            found = examined(mesh_of(solid))
        notes += [note.within(f"bodies.{name}") for note in (*found, *locking_notes(solid, fixed[name]))]
    return tuple(notes)


def contact_notes(model: Model) -> tuple[Note, ...]:
    """Notes on contacts of curved surfaces whose facets stand off the curve as far as the gap or interference is.

    Against a tool only the nodes of the solid count, and the facets of the tool.
    """
    notes = []
    for k, contact in enumerate(model.scene.contacts):
        one, other = model.opponents[k]
        mortar = contact.timing.massless and not isinstance(contact.method, NodeToSurface)
        tool = model.tools.get(contact.opponent)
        second = None if tool is None else curved_tool(tool)
        if model.shape[1] == 1 or (tool is not None and second is None):
            continue
        first = _curved(model, int(one), contact.tag, mortar)
        if second is None:
            second = _curved(model, int(other), contact.opponent_tag, mortar)
        else:
            first = replace(first, factor=0.0)
        fit = contact.start == "fit"
        found = misfit(first, second, fit)
        least = ROUNDING * min(float(model.edge[model.parts[part].nodes].min()) for part in (one, other) if part >= 0)
        if found is not None and found.off > max(least, SHARE * abs(found.gap)):
            notes.append(_off(k, contact, found, tool is not None))
    return tuple(notes)


def _curved(model: Model, number: int, tag: str, mortar: bool) -> CurvedSurface:
    """Curvature of a surface of a solid at the initial displacement."""
    part = model.parts[number]
    facets = {name: nodes + part.nodes.start for name, nodes in part.mesh.facets_on(tag).items()}
    return curved_surface(ContactSurface(facets=facets), model.points + model.displacement, mortar)


def _off(k: int, contact: Contact, found: Misfit, tool: bool) -> Note:
    """Note on facets that stand off the curve through their nodes, those of a tool or of two solids."""
    share = f" ({found.off / abs(found.gap):.0%} of it)" if found.gap else ""
    what = f"the interference is {-found.gap:.3g} m" if contact.start == "fit" else f"the gap is {found.gap:.3g} m"
    whose = f"the tool {contact.opponent!r}" if tool else " and ".join(repr(name) for name in contact.between)
    problem = (
        f"the facets of {whose} stand up to {found.off:.3g} m off the curves through their "
        f"nodes, and {what}{share}: pressures may be wrong by this share, and more from node to node"
    )
    remedy = "the same nodes along both surfaces, or shorter edges: half the edge leaves a quarter of the distance"
    if tool:
        remedy = "smooth = true for a shape without sharp edges, or " + remedy.partition("or ")[2]
    return Note(where=f"contacts[{k}].between", problem=problem, remedy=remedy)
