"""Scene of a scenario with all meshes built and placed."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

from softway.bodies.setup.placement import Placement, in_place
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.tie import Tie
from softway.errors import InputError, within
from softway.meshes.files.listed_mesh import FileTie, LeftOut
from softway.meshes.files.mesh_files import FileMesh
from softway.meshes.generators.recipes import Divided, MeshFile, MeshSource
from softway.meshes.mesh import Mesh
from softway.model.scene import Scene
from softway.scenario.scenario import Scenario


def built(scenario: Scenario) -> Scene:
    """Scene with all meshes built and placed.

    Raises
    ------
    InputError
        For a missing mesh file, an inverted cell or an impossible size, with the path of the mesh.
    """
    return built_and_left_out(scenario)[0]


def built_and_left_out(scenario: Scenario) -> tuple[Scene, dict[str, tuple[LeftOut, ...]]]:
    """Scene with all meshes built and placed, with the ties of mesh files after its own, and the cards of mesh files
    that it does not hold, by body.
    """
    scene, read = scenario.scene, dict[str, FileMesh]()
    bodies = dict(scene.bodies)
    for name, body in scene.bodies.items():
        if isinstance(body, Solid):
            bodies[name], read[name] = _built(body, f"bodies.{name}")
    left_out = {name: found.left_out for name, found in read.items() if found.left_out}
    ties, known = list(scene.ties), {tuple(sorted(tie.between)) for tie in scene.ties}
    for names in _files(scene.bodies).values():
        for given in read[names[0]].ties:
            made = _ties(given, {name: read[name].mesh for name in names})
            ties += [tie for tie in made if tuple(sorted(tie.between)) not in known]
            known |= {tuple(sorted(tie.between)) for tie in made}
            if not made:
                left_out[names[0]] = (*left_out.get(names[0], ()), _lost(given, [read[name].mesh for name in names]))
    return replace(scene, bodies=bodies, ties=tuple(ties)), left_out


def _files(bodies: Mapping[str, Solid | Tool]) -> dict[Path, list[str]]:
    """Names of the solids whose meshes are of the same file."""
    found: dict[Path, list[str]] = {}
    for name, body in bodies.items():
        mesh = body.mesh if isinstance(body, Solid) else None
        mesh = mesh.mesh if isinstance(mesh, Divided) else mesh
        if isinstance(mesh, MeshFile):
            found.setdefault(Path(mesh.path), []).append(name)
    return found


def _ties(given: FileTie, meshes: Mapping[str, Mesh]) -> list[Tie]:
    """Ties of a file between bodies: within each one that has both surfaces, or else of the only two that have them."""
    one, two = ([name for name, mesh in meshes.items() if _has(mesh, tag)] for tag in given.between)
    pairs = [(name, name) for name in one if name in two] or list(product(one, two))
    if len(pairs) > 1 and pairs[0][0] != pairs[0][1]:
        return []
    return [Tie(between=(f"{a}.{given.between[0]}", f"{b}.{given.between[1]}")) for a, b in pairs]


def _lost(given: FileTie, meshes: Sequence[Mesh]) -> LeftOut:
    """Tie of a file that is none of the bodies."""
    bodies = [sum(_has(mesh, tag) for mesh in meshes) for tag in given.between]
    absent = [tag for tag, count in zip(given.between, bodies, strict=True) if not count]
    why = f"no body has facets on {absent[0]:.60}" if absent else "several bodies have its surfaces"
    return LeftOut(card=given.title, count=1, lines=(given.line,), meaning=f"{why}: nothing is glued")


def _has(mesh: Mesh, tag: str) -> bool:
    """True if a mesh has facets on a tag."""
    return tag in mesh.tags and bool(mesh.facets_on(tag))


def _built(solid: Solid, where: str) -> tuple[Solid, FileMesh]:
    """Solid with a built mesh instead of the recipe, and what its file holds."""
    try:
        read = solid.mesh.read() if isinstance(solid.mesh, MeshFile | Divided) else FileMesh(_mesh(solid.mesh))
    except InputError as error:
        raise error.within(f"{where}.mesh") from None
    with within(where):
        mesh = in_place(read.mesh, solid.mesh, (solid.place, *solid.group), solid.adapt, solid.section)
    return replace(solid, mesh=mesh, place=Placement(), group=()), read


def _mesh(mesh: MeshSource | Mesh) -> Mesh:
    """Mesh, or the one of a recipe."""
    return mesh if isinstance(mesh, Mesh) else mesh.build()
