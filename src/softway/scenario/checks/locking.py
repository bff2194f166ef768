"""Notes on cells that lock: isochoric flow, nearly incompressible material, and bending of thin bodies."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.elements.section import Bar, PlaneStrain, PlaneStress, Section
from softway.bodies.internal_force.materials import laws_of
from softway.bodies.internal_force.slab_average import DiscreteGradient
from softway.bodies.solid import Solid
from softway.errors import Note
from softway.laws.law import Increment, Material, RateLaw, initial_moduli
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.meshes.thickness import OPPOSITE, Layers, layers
from softway.scenario.checks.names import mesh_of
from softway.scenario.checks.scales import section_of

INCOMPRESSIBLE = 0.49
"""Poisson's ratio from which linear cells with the volume change at each point lock."""
SHEAR = 10.0
"""Shear strain in one second, at which a law with a history is tested for isochoric flow."""
WRONG = 0.1
"""Error of the bending stiffness that is noted."""
OUTLINE = 300
"""Number of surface nodes from which the extent of a body is taken."""
SLENDER = 5.0
"""Extent of a body, in thicknesses, from which it bends."""


def locking_notes(solid: Solid, fixed: BoolArray) -> tuple[Note, ...]:
    """Notes on the cells of a solid whose supports hold the components ``fixed`` (n, d); one on each for all laws."""
    section = section_of(solid, mesh_of(solid))
    if isinstance(section, Bar):
        return ()
    notes: dict[str, Note] = {}
    for law in laws_of(solid.material):
        volume = _volume_note(solid, law, section)
        for note in (*volume, *_bending_note(solid, law, section, fixed, incompressible=bool(volume))):
            notes.setdefault(note.where, note)
    return tuple(notes.values())


def poisson(moduli: Array) -> float:
    """Poisson's ratio of the isotropic part of moduli (3, 3, 3, 3).

    Examples
    --------
    >>> from softway.laws.bulk import NeoHookean
    >>> round(poisson(initial_moduli(NeoHookean(E=1.0, nu=0.3))), 9)
    0.3
    """
    bulk = float(np.einsum("iijj", moduli)) / 9.0
    shear = (float(np.einsum("ijij", moduli)) - 3.0 * bulk) / 10.0
    return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))


def flowing(material: Material) -> float:
    """Poisson's ratio of a material that flows: 1/2 for plastic and viscous flow, that of rest for an elastic law.

    Examples
    --------
    >>> from softway.laws.bulk import J2, Hypoelastic
    >>> round(flowing(J2(E=1.0, nu=0.3, yield_stress=1e-3)), 2), round(flowing(Hypoelastic(E=1.0, nu=0.3)), 2)
    (0.5, 0.3)
    """
    if not isinstance(material, RateLaw):
        return poisson(initial_moduli(material))
    strain = np.zeros((1, 3, 3))
    strain[0, 0, 1] = strain[0, 1, 0] = 0.5 * SHEAR
    given = Increment(stress=np.zeros((1, 3, 3)), memory=material.virgin(1), strain=strain, span=1.0)
    return poisson(material.moduli(given)[0])


@dataclass(frozen=True, slots=True, kw_only=True)
class _Errors:
    """Errors of the bending stiffness: ``shear`` times (length/thickness)^2, plus ``layer`` / (layers)^2."""

    shear: float
    layer: float


def _errors(solid: Solid, law: Material, section: Section, incompressible: bool) -> _Errors:
    """Errors of the bending stiffness of bilinear cells (docs/theory/bodies/locking.md).

    The longitudinal strain is linear across a cell, but neither the rotation along it nor the lateral strain is.
    """
    nu = poisson(initial_moduli(law))
    plane = 1.0 - nu**2  # modulus of a wide plate E / (1 - nu^2)
    if isinstance(section, PlaneStress):
        shear, point, mean = 0.5 / (1.0 + nu), 1.0 / plane, 0.5 / (1.0 + nu)
    else:
        shear = 0.5 * (1.0 - nu)
        point = (1.0 - nu) ** 2 / (1.0 - 2.0 * nu) if nu < INCOMPRESSIBLE else 1.0
        mean = shear if isinstance(section, PlaneStrain) else 4.0 / 3.0 * shear
    cell = {"point": 1.0 if incompressible else point, "mean": mean}.get(solid.dilatation, 1.0)
    return _Errors(shear=shear, layer=cell - 1.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Bent:
    """Lengths (k,) of cells along a body, its thickness (k,) there [m], and the number (k,) of layers."""

    length: Array
    thickness: Array
    count: Array


def _bends(mesh: Mesh, found: Layers, fixed: BoolArray) -> _Bent:
    """Layers of a body where it is slender and no support keeps it from bending."""
    across = mesh.points[found.facets].mean(axis=1) - mesh.points[found.ends].mean(axis=1)
    moved = np.abs(across) > 0.1 * found.thickness[:, None]
    held = [(fixed[nodes].all(axis=1) | ~moved).all(axis=1) for nodes in (found.facets, found.ends)]
    free = ~(held[0] | held[1])
    surface = mesh.nodes("surface")
    outline = mesh.points[surface[:: max(len(surface) // OUTLINE, 1)]]
    length, thickness, count = [], [], []
    for first, last in ((0, 1), (0, found.facets.shape[1] - 1)):
        edge = mesh.points[found.facets[:, last]] - mesh.points[found.facets[:, first]]
        size = np.linalg.norm(edge, axis=1)
        extent = np.ptp(outline @ (edge / size[:, None]).T, axis=0)
        bends = free & (extent >= SLENDER * found.thickness)
        length.append(size[bends])
        thickness.append(found.thickness[bends])
        count.append(found.count[bends])
    return _Bent(length=np.concatenate(length), thickness=np.concatenate(thickness), count=np.concatenate(count))


def _volume_note(solid: Solid, law: Material, section: Section) -> tuple[Note, ...]:
    """Note on linear cells whose volume cannot stay constant at each point while they deform."""
    mesh, ratio = mesh_of(solid), flowing(law)
    kinds = [name for name in mesh.blocks if CELLS[name].order == 1]
    simplices = any(CELLS[name].simplex for name in kinds)
    if not kinds or isinstance(section, PlaneStress) or not ratio >= INCOMPRESSIBLE:
        return ()
    if solid.dilatation != "point" and not simplices:
        return ()
    rest = poisson(initial_moduli(law))
    flows = rest < INCOMPRESSIBLE and kinds == ["tri3"]  # in flow averages at the nodes are as good as in quad4
    if flows and solid.dilatation == "corner":
        return ()
    why = f"nu = {rest:.6g}" if rest >= INCOMPRESSIBLE else "which flows at constant volume"
    lock = f"{', '.join(kinds)} lock with {type(law).__name__}, {why}"
    problem = f"{lock}: too stiff where they have to deform at constant volume"
    quadratic = f'quadratic cells ({"tri6" if mesh.dim == 2 else "tet10"}) with dilatation = "corner"'
    quadratic += ", or tri3 with it where the flow is large" if flows else ""
    force = ' and force = { kind = "Weighted" }' if isinstance(solid.force, DiscreteGradient) else ""
    remedy = (quadratic if simplices else 'dilatation = "mean"') + force
    return (Note(where="dilatation", problem=problem, remedy=remedy),)


def _bending_note(
    solid: Solid, law: Material, section: Section, fixed: BoolArray, *, incompressible: bool
) -> tuple[Note, ...]:
    """Note on quadrilaterals and hexahedra that are long, or too few, for the thickness of a body that can bend."""
    mesh, worst = mesh_of(solid), None
    errors = _errors(solid, law, section, incompressible)
    for name in OPPOSITE.keys() & mesh.blocks.keys():
        bent = _bends(mesh, layers(mesh, name), fixed)
        error = errors.shear * (bent.length / bent.thickness) ** 2 + errors.layer / bent.count**2
        if len(error) and (worst is None or np.abs(error).max() > abs(worst[0])):
            k = int(np.argmax(np.abs(error)))
            worst = float(error[k]), name, float(bent.length[k]), float(bent.thickness[k]), int(bent.count[k])
    if worst is None or abs(worst[0]) < WRONG:
        return ()
    wrong, name, length, thickness, count = worst
    kind = "stiff" if wrong > 0.0 else "soft"
    amount = f"about {abs(wrong):.0%}" if wrong < 2.0 else f"{wrong + 1.0:.2g} times"
    problem = (
        f"{count} {'layer' if count == 1 else 'layers'} of {name} of the length {length:.3g} m in a thickness of "
        f"{thickness:.3g} m: where the body bends, it is {amount} too {kind}"
    )
    quadratic = {"quad4": "quad9", "hex8": "hex27"}[name]
    dilatation = f' and dilatation = "{"corner" if incompressible or solid.dilatation != "point" else "point"}"'
    shorter = "shorter cells, and three layers or more" if count < 3 else "shorter cells"
    return (Note(where="mesh", problem=problem, remedy=f"{quadratic}{dilatation}, or {shorter}"),)
