"""Model of a scene: meshes, tables, mass, degrees of freedom and contacts."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import IntArray
from softway.bodies.assembled.nodal_loads import dead_load
from softway.bodies.assembled.nodal_masses import Massless, inertia_of
from softway.bodies.assembled.tangent import assembled_tangent
from softway.bodies.discretised import (
    DiscreteSolid,
    Moved,
    driven_components,
)
from softway.bodies.dof_map import DofMap, MatrixSum
from softway.bodies.inertia.matrix_sum import bonded_sum
from softway.bodies.rigid_motion import CarriedNodes, RigidMotion, RigidShape
from softway.bodies.setup.directions import DirectedMotion
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.declared import at_declared, resolved
from softway.contact.impact_rule import Energy, ImpactRule
from softway.errors import InputError, within
from softway.meshes.topology import require_none
from softway.model.cohesive_ties import CohesiveTies, intact
from softway.model.field import FieldEquations, HangingField
from softway.model.initial_displacement import at_start, given_fields
from softway.model.known_solids import kept_slaves, known_inertias, known_parts
from softway.model.layout import Layout, laid_out, solids_of
from softway.model.model import Model
from softway.model.rigid.rigid_bodies import RigidBodies, rigid_bodies
from softway.model.rigid.rigid_refusals import require_fitting
from softway.model.scene import Scene
from softway.model.ties import joined, linked_parts
from softway.tolerances import MOTION


def build(scene: Scene) -> Model:
    """Build the model of a scene without heat: meshes, tables, mass and contacts.

    Raises
    ------
    InputError
        With the place in the scene: if a tag matches nothing, a body does not exist, or dimensions are mixed; if a
        solid, a load or a contact has heat, with which ``softway.build`` builds a scene.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> from softway.meshes.generators.recipes import Interval
    >>> bar = Solid(mesh=Interval(length=1.0, cells=1), material=LinearElastic(E=1.0), density=1.0)
    >>> build(Scene(bodies={"bar": bar})).shape
    (2, 1)
    """
    heated = (f"bodies.{name}.thermal" for name, body in scene.bodies.items() if _has_heat(body))
    loads = (f"loads[{k}]" for k, load in enumerate(scene.loads) if not isinstance(load, Gravity | Traction))
    contacts = (f"contacts[{k}].heat" for k, contact in enumerate(scene.contacts) if contact.heat is not None)
    rigid = {} if scene.mechanism is None else scene.mechanism.bodies
    lumps = (f"bodies.{name}.thermal" for name, body in rigid.items() if body.thermal is not None)
    for where in (*heated, *lumps, *loads, *contacts):
        raise InputError(where, "heat in a model of the motion alone", "softway.build, or a scene without heat")
    return mechanical(scene)


def _has_heat(body: object) -> bool:
    """True if a body is a solid with a temperature."""
    return isinstance(body, Solid) and body.thermal is not None


def mechanical(scene: Scene, known: Model | None = None) -> Model:
    """Model of the motion of a scene, whose heat it leaves out; errors as of :func:`build`.

    It has the arrays of the ``known`` model for the very same solids, with the same bits as without.
    """
    found = resolved(scene.contacts, *_members(scene))
    numbers = tuple(number for number, _ in found)
    with at_declared(numbers):
        model = _model(replace(scene, contacts=tuple(contact for _, contact in found)), known)
    return replace(model, declared=numbers)


def _model(scene: Scene, before: Model | None) -> Model:
    """Model of a scene whose contacts name all their members."""
    timing, factor, (rigid, motions) = _timing(scene), scene.inertia.factor, _rigid(scene)
    tools, massless = _tools(scene, rigid, motions), timing.massless and factor > 0.0
    laid = laid_out(scene, motions, tools, massless, known_parts(before), kept_slaves(before))
    scene, solids, parts, glue, met = laid.scene, laid.solids, laid.parts, laid.glue, laid.met
    given, velocity = given_fields(parts, solids)
    dofs, driven = glue.dofs(joined([p.dofs for p in parts])), driven_components(parts, solids, given, motions)
    light, inertias = _light(laid, massless, driven, timing.spread), known_inertias(before, scene, laid.parts)
    mass, weights, follow = inertia_of(parts, solids, light, factor, inertias)
    displacement, loads = at_start(parts, solids, given, driven, glue), dead_load(parts, weights, scene.loads, "loads")
    return Model(
        scene=scene, parts=parts, mass=mass, follow=follow, passing=sp.csr_array(follow.T),
        massive=np.asarray(mass.diagonal()) > 0.0, inert=factor > 0.0, part_of=_part_of(parts), dofs=dofs,
        linked=linked_parts(_part_of(parts), len(parts), dofs, laid.bonds),
        load=loads.at(0.0), load_before=loads.at(0.0), loads=loads, weight=weights, displacement=displacement,
        velocity=glue.fitting(velocity - dofs.supported(velocity), "velocity", parts),
        contacts=met.contacts.cleared(displacement, [c.start == "apart" for c in scene.contacts]),
        contact_solids=met.solids, against_tool=met.rigid, touchable=met.nodes,
        edge=np.concatenate([p.mesh.edges() for p in parts]),
        driven=driven, floor=np.array([p.floor() for p in parts]), total=_total(mass, parts, dofs, laid.bonds),
        timing=timing, friction=met.friction, space=met.contacts.space,
        companions=intact(laid.bonds, displacement), tools=tools, rigid=rigid,
    )  # fmt: skip


def _members(scene: Scene) -> tuple[list[str], list[str]]:
    """Names of the solids, and of the tools and rigid bodies with a surface."""
    tools = [name for name, body in scene.bodies.items() if isinstance(body, Tool)]
    if scene.mechanism is not None:
        tools += [name for name, body in scene.mechanism.bodies.items() if body.shape is not None]
    solids = [name for name, body in scene.bodies.items() if isinstance(body, Solid)]
    return solids, tools


def _part_of(parts: Sequence[DiscreteSolid]) -> IntArray:
    """Number (n,) of the solid of each node."""
    return np.repeat(np.arange(len(parts)), [p.mesh.n_nodes for p in parts])


def _light(laid: Layout, massless: bool, driven: Sequence[Moved], spread: int) -> Massless:
    """Nodes without inertia: those that may touch if they are ``massless``, and those that rigid bodies carry."""
    return Massless(laid.light if massless else laid.light[:0], _carried(driven), spread)


def _carried(driven: Sequence[Moved]) -> IntArray:
    """Nodes (c,) that rigid bodies carry."""
    return np.concatenate([np.zeros(0, int), *(s.nodes for s, _ in driven if isinstance(s, CarriedNodes))])


def _rigid(scene: Scene) -> tuple[RigidBodies | None, dict[str, RigidMotion]]:
    """Rigid bodies of the scene, and their motions at the start; None without."""
    if scene.mechanism is None:
        return None, {}
    found = rigid_bodies(scene.mechanism)
    require_fitting(scene, found, tuple(solids_of(scene).values()))
    return found, found.coasting_motions()


def _tools(scene: Scene, rigid: RigidBodies | None, motions: Mapping[str, RigidMotion]) -> dict[str, Tool | RigidShape]:
    """Tools, and the shapes of the rigid bodies in their motion at the start."""
    tools: dict[str, Tool | RigidShape] = {n: b for n, b in scene.bodies.items() if isinstance(b, Tool)}
    if rigid is None:
        return tools
    return tools | rigid.shapes(motions)


def _total(
    mass: sp.csr_array, parts: Sequence[DiscreteSolid], dofs: DofMap, bonds: tuple[CohesiveTies, ...]
) -> MatrixSum:
    """Assembly of mass (n, n) plus tangent stiffness on the unknowns."""
    inertia = sp.csc_array(sp.kron(mass, sp.eye_array(dofs.free.shape[1]), format="csc"))
    stiffness = assembled_tangent(parts, np.zeros(dofs.free.shape))
    if not bonds:
        return dofs.sum(inertia, stiffness)
    return bonded_sum(dofs, inertia, stiffness, sp.csr_array(sp.vstack([bond.rows for bond in bonds])))


def _timing(scene: Scene) -> ImpactRule:
    rules = {c.timing for c in scene.contacts}
    if len(rules) > 1:
        raise InputError("contacts", f"{len(rules)} different timing rules in one scene", "the same timing for all")
    timing = rules.pop() if rules else Energy()
    if scene.inertia.factor == 0.0 and not timing.massless:
        problem = f"Off with the rule {type(timing).__name__}, whose contact nodes have inertia"
        raise InputError("inertia", problem, "the timing Energy")
    return timing


def with_dofs(model: Model, dofs: DofMap) -> Model:
    """Model whose nodes are moved by other unknowns: ties, rigid parts, hanging nodes (docs/theory/solver/dof_map.md).

    Solids that share an unknown form one group, whose energy balance is closed as one.

    Raises
    ------
    InputError
        If the map does not fit the nodes, moves driven components, moves nodes with and without inertia by the same
        unknown, or does not contain the initial fields.

    Examples
    --------
    Two bars whose ends are glued:

    >>> import softway as sw
    >>> from softway.bodies.dof_map import CombinedDofs
    >>> def bar(a):
    ...     mesh = sw.meshes.Interval(length=1.0, cells=1, origin=a)
    ...     return sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0, nu=0.0), density=1.0)
    >>> model = sw.build(sw.Scene(bodies={"left": bar(0.0), "right": bar(1.0)}))
    >>> glue = sp.csr_array(np.array([[1.0, 0, 0], [0, 1, 0], [0, 1, 0], [0, 0, 1]]))
    >>> with_dofs(model, CombinedDofs(glue, 1)).linked.tolist()
    [0, 0]
    """
    if dofs.free.shape != model.shape:
        raise InputError("dofs", f"a map for nodes (n, d) = {dofs.free.shape}", f"a map for {model.shape}")
    for support, where in model.driven:
        given = np.zeros(model.shape)
        given[where] = support.shares[0] if isinstance(support, DirectedMotion) else 1.0
        if not np.allclose(dofs.supported(given), given, rtol=0.0, atol=MOTION):
            raise InputError("dofs", f"unknowns move components driven by {support}", "empty rows for them")
    heavy = set(dofs.moving(np.flatnonzero(model.massive)).tolist())
    mixed = heavy.intersection(dofs.moving(np.flatnonzero(~model.massive)).tolist())
    if mixed:
        problem = f"{len(mixed)} unknowns move contact nodes without inertia together with others"
        raise InputError("dofs", problem, "unknowns of their own for contact nodes, or the rule Impulse")
    for name, field in (("displacement", model.displacement), ("velocity", model.velocity)):
        left = model.space.greatest(dofs.nodes(dofs.unknowns(field)) - field)
        if left > MOTION * model.space.greatest(field):
            raise InputError("dofs", f"the initial {name} differs by {left:.3g} from any of the map", f"another {name}")
    return replace(
        model,
        dofs=dofs,
        linked=linked_parts(model.part_of, len(model.parts), dofs, model.bonds),
        total=_total(model.mass, model.parts, dofs, model.bonds),
    )


def with_field(model: Model, equations: FieldEquations) -> Model:
    """Model with a companion field, which is solved together with the displacement (docs/theory/solver/fields.md).

    Raises
    ------
    InputError
        If there is a field of this name, the initial values do not fit, or nodes hang that its values do not follow.
    """
    new, shape = equations.field, equations.initial().shape
    if new.name in {f.name for f in model.fields} or new.name in ("velocity", "contact_force"):
        raise InputError(f"fields.{new.name}", "a second field of this name", "another name")
    if shape != (model.shape[0], new.components):
        raise InputError(f"fields.{new.name}", f"initial values {shape}", f"{(model.shape[0], new.components)}")
    follows = isinstance(equations, HangingField) and equations.hangs
    for part in () if follows else model.parts:
        with within(f"bodies.{part.name}"):
            require_none(part.mesh.hanging, f"companion field {new.name}")
    return replace(model, companions=(*model.companions, equations))
