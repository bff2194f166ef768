"""Model of a scene: meshes, tables, mass, degrees of freedom and contacts."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import Array, IntArray
from softway.bodies.assembled.nodal_loads import dead_load
from softway.bodies.assembled.nodal_masses import solid_following, solid_mass
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.discretised import (
    MOVING,
    DiscreteSolid,
    Moved,
    discretise,
    driven_components,
    initial,
    supported_components,
)
from softway.bodies.dof_map import DofMap, MatrixSum, joined
from softway.bodies.rigid_motion import CarriedNodes, RigidMotion, RigidShape
from softway.bodies.solid import Solid, Tool
from softway.contact.assemble import assemble_contacts
from softway.contact.impact_rule import Energy, ImpactRule
from softway.errors import InputError, within
from softway.model.field import FieldEquations
from softway.model.model import Model, assembled_tangent
from softway.model.rigid_bodies import RigidBodies, rigid_bodies
from softway.model.rigid_refusals import require_fitting
from softway.model.scene import Scene, StaticStart
from softway.tolerances import MOTION


def build(scene: Scene) -> Model:
    """Build the model of a scene: meshes, tables, mass and contacts.

    Raises
    ------
    InputError
        With the place in the scene: if a tag matches nothing, a body does not exist, or dimensions are mixed.
    """
    solids, timing, factor = _solids(scene), _timing(scene), scene.inertia.factor
    parts, (rigid, motions) = _parts(solids), _rigid(scene, tuple(solids.values()))
    tools, space = _tools(scene, rigid, motions), LocalSpace(tuple(p.nodes for p in parts))
    met = assemble_contacts(scene.contacts, {**solids, **tools}, parts, space)
    fields, velocity = _initial_fields(parts, solids)
    driven = driven_components(parts, solids, np.concatenate(fields), motions)
    dofs = joined([p.dofs for p in parts])
    light = _Massless(met.nodes if timing.massless and factor > 0.0 else met.nodes[:0], _carried(driven), timing.spread)
    mass, weights, follow = _inertia(parts, solids, light, factor)
    displacement, loads = _displacement(parts, solids, fields, driven), dead_load(parts, weights, scene.loads, "loads")
    return Model(
        scene=scene,
        parts=parts,
        mass=mass,
        follow=follow,
        massive=np.asarray(mass.diagonal()) > 0.0,
        inert=factor > 0.0,
        part_of=np.repeat(np.arange(len(parts)), [p.mesh.n_nodes for p in parts]),
        dofs=dofs,
        linked=np.arange(len(parts)),
        load=loads.at(0.0),
        load_before=loads.at(0.0),
        loads=loads,
        weight=weights,
        displacement=displacement,
        velocity=velocity * dofs.free,
        contacts=met.contacts.cleared(displacement, [c.start == "apart" for c in scene.contacts]),
        opponents=met.opponents,
        touchable=met.nodes,
        edge=np.concatenate([p.mesh.edges() for p in parts]),
        driven=driven,
        floor=np.array([p.floor() for p in parts]),
        total=_total(mass, parts, dofs),
        timing=timing,
        friction=met.friction,
        space=met.contacts.space,
        tools=tools,
        rigid=rigid,
    )


def _initial_fields(parts: Sequence[DiscreteSolid], solids: Mapping[str, Solid]) -> tuple[list[Array], Array]:
    """Given initial displacements (n, d) of the parts, and the velocity (n, d) of all nodes."""
    fields = [initial(p, solids[p.name]) for p in parts]
    return [u for u, _ in fields], np.concatenate([v for _, v in fields])


def _displacement(
    parts: Sequence[DiscreteSolid],
    solids: Mapping[str, Solid],
    fields: Sequence[Array],
    driven: Sequence[Moved],
) -> Array:
    """Initial displacement (n, d) from those of the parts; driven components keep theirs, fixed ones are zero.

    Raises
    ------
    InputError
        If a Fixed support holds a component whose initial displacement is not zero, beyond rounding.
    """
    out = np.concatenate(fields)
    moved = np.logical_or.reduce([where for _, where in driven], initial=False) | np.zeros(out.shape, bool)
    for part, field in zip(parts, fields, strict=True):
        for k, support in enumerate(solids[part.name].supports):
            if isinstance(support, MOVING):
                continue
            held = supported_components(support, part.mesh) & ~moved[part.nodes]
            wrong = held & (np.abs(field) > MOTION * np.abs(field).max())
            if wrong.any():
                node, axis = (int(i) for i in np.argwhere(wrong)[0])
                value, count = f"{field[node, axis]:.6g} m along {'xyz'[axis]}", int(wrong.any(axis=1).sum())
                problem = f"{value} at node {node}, which supports[{k}] on {support.on!r} holds at zero; {count} in all"
                remedy = f'a field that is zero on {support.on!r}, or a support of kind = "Driven" with velocity = 0'
                raise InputError(f"bodies.{part.name}.displacement", problem, remedy)
            out[part.nodes][held] = 0.0
    return out


@dataclass(frozen=True, slots=True, eq=False)
class _Massless:
    """Nodes without inertia: those ``touching`` (k,), whose mass is spread over some layers of cells, and those that
    rigid bodies carry, ``carried`` (c,).
    """

    touching: IntArray
    carried: IntArray
    spread: int

    def of(self, nodes: slice) -> tuple[IntArray, int]:
        """Numbers of those of a solid in it, and the layers of cells."""
        both = self.touching, self.carried
        mine = [some[(some >= nodes.start) & (some < nodes.stop)] - nodes.start for some in both]
        return np.unique(np.concatenate(mine)), self.spread if len(mine[0]) else 1


def _carried(driven: Sequence[Moved]) -> IntArray:
    """Nodes (c,) that rigid bodies carry."""
    return np.concatenate([np.zeros(0, int), *(s.nodes for s, _ in driven if isinstance(s, CarriedNodes))])


def _inertia(
    parts: Sequence[DiscreteSolid], solids: Mapping[str, Solid], light: _Massless, factor: float
) -> tuple[sp.csr_array, Array, sp.csr_array]:
    """Mass (n, n) times the ``factor``, nodal mass (n,) for the weight, and velocities (n, n) of all nodes from those
    with mass.
    """
    own = [light.of(p.nodes) for p in parts]
    masses = [solid_mass(p, solids[p.name], nodes, layers) for p, (nodes, layers) in zip(parts, own, strict=True)]
    follow = [solid_following(p, nodes) for p, (nodes, _) in zip(parts, own, strict=True)]
    weight, following = (sp.csr_array(sp.block_diag(blocks, format="csr")) for blocks in (masses, follow))
    mass = sp.csr_array(factor * weight) if factor > 0.0 else sp.csr_array(weight.shape)
    return mass, np.asarray(weight.sum(axis=1)).ravel(), following


def _solids(scene: Scene) -> dict[str, Solid]:
    solids = {n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}
    if not solids:
        raise InputError("bodies", "no Solid among them", "at least one body of kind Solid")
    return solids


def _parts(solids: Mapping[str, Solid]) -> tuple[DiscreteSolid, ...]:
    parts: list[DiscreteSolid] = []
    for name, solid in solids.items():
        with within(f"bodies.{name}"):
            parts.append(discretise(name, solid, parts[-1].nodes.stop if parts else 0))
    if len({p.mesh.dim for p in parts}) > 1:
        raise InputError("bodies", "solids of different space dimension in one scene", "meshes of one dimension")
    return tuple(parts)


def _rigid(scene: Scene, solids: Sequence[Solid]) -> tuple[RigidBodies | None, dict[str, RigidMotion]]:
    """Rigid bodies of the scene, and their motions at the start; None without."""
    if scene.mechanism is None:
        return None, {}
    found = rigid_bodies(scene.mechanism)
    require_fitting(scene, found, solids)
    return found, found.coasting_motions()


def _tools(scene: Scene, rigid: RigidBodies | None, motions: Mapping[str, RigidMotion]) -> dict[str, Tool | RigidShape]:
    """Tools, and the shapes of the rigid bodies in their motion at the start."""
    tools: dict[str, Tool | RigidShape] = {n: b for n, b in scene.bodies.items() if isinstance(b, Tool)}
    if rigid is None:
        return tools
    return tools | rigid.shapes(motions)


def _total(mass: sp.csr_array, parts: Sequence[DiscreteSolid], dofs: DofMap) -> MatrixSum:
    """Assembly of mass (n, n) plus tangent stiffness on the unknowns."""
    inertia = sp.csc_array(sp.kron(mass, sp.eye_array(dofs.free.shape[1]), format="csc"))
    return dofs.sum(inertia, assembled_tangent(parts, np.zeros(dofs.free.shape)))


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
        if (dofs.free & where).any():
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
    return replace(model, dofs=dofs, linked=_linked(model, dofs), total=_total(model.mass, model.parts, dofs))


def _linked(model: Model, dofs: DofMap) -> IntArray:
    """Group (parts,) of each solid; solids that share unknowns have the same."""
    if dofs.components is not None:
        return np.arange(len(model.parts))
    of = np.repeat(model.part_of, model.shape[1])
    shares = sp.csr_array((np.ones(len(of)), (of, np.arange(len(of))))) @ abs(dofs.jacobian)
    return np.asarray(connected_components(shares @ shares.T, directed=False)[1])


def with_field(model: Model, equations: FieldEquations) -> Model:
    """Model with a companion field, which is solved together with the displacement (docs/theory/solver/fields.md).

    Raises
    ------
    InputError
        If there is a field of this name, the initial values do not fit, or the march starts in static equilibrium,
        which knows no companion fields.
    """
    new, shape = equations.field, equations.initial().shape
    if new.name in {f.name for f in model.fields} or new.name in ("velocity", "contact_force"):
        raise InputError(f"fields.{new.name}", "a second field of this name", "another name")
    if shape != (model.shape[0], new.components):
        raise InputError(f"fields.{new.name}", f"initial values {shape}", f"{(model.shape[0], new.components)}")
    if isinstance(model.scene.start, StaticStart):
        raise InputError("start", f"StaticStart with the field {new.name}", 'start = "AsGiven"')
    return replace(model, companions=(*model.companions, equations))
