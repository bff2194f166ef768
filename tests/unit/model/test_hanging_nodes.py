"""Models of meshes with hanging nodes: constant strain, supports, and what does not fit them."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.marking.even_surface import even
from softway.arrays import Array
from softway.errors import InputError
from softway.meshes.adaptive.refinement import refined
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh
from softway.model.build import build
from softway.model.scene import StaticStart

CELLS = ["quad4", "quad8", "quad9", "hex8", "hex20", "hex27"]


def mixed(cell: str, warp: float = 0.0) -> Mesh:
    """A square or a cube whose cells have two or three sizes, with its inner nodes moved by ``warp``."""
    linear = cell[:3] == "hex"
    base = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell) if linear else rectangle((1.0, 1.0), (4, 4), cell=cell)
    if warp:
        inner = ((base.points > 0.0) & (base.points < 1.0)).all(axis=1)
        shift = np.random.default_rng(2).uniform(-warp, warp, base.points.shape)
        base = replace(base, points=base.points + shift * inner[:, None])
    levels = np.zeros(base.n_cells, dtype=np.int64)
    levels[[0, 5] if linear else [0, 6, 13]] = 2 * base.dim if cell in ("quad4", "quad8", "quad9", "hex8") else 3
    return refined(base, levels).mesh


def solid(mesh: Mesh, **others: object) -> sw.Solid:
    parts = {"mesh": mesh, "material": sw.LinearElastic(E=1.0, nu=0.3), "density": 1.0, **others}
    return sw.Solid(**parts)  # type: ignore[arg-type]


def followed(mesh: Mesh, field: Array) -> None:
    """The values at hanging nodes are those of the larger cells."""
    assert mesh.hanging is not None
    assert mesh.hanging.following(field) == pytest.approx(field, abs=1e-14 * max(1.0, abs(field).max()))


@pytest.mark.parametrize("cell", CELLS)
def test_constant_strain_has_no_force_inside(cell: str) -> None:
    mesh = mixed(cell, 0.03)
    model = build(sw.Scene(bodies={"body": solid(mesh)}))
    u = mesh.points @ np.random.default_rng(1).normal(size=(mesh.dim, mesh.dim)).T
    assert model.dofs.nodes(model.dofs.unknowns(u)) == pytest.approx(u, abs=1e-13)
    force = model.force(u)
    inner = np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes("surface"))
    assert abs(force[inner]).max() > 1e-3 * abs(force).max()  # hanging nodes have one, and pass it on
    assert abs(model.dofs.gathered(force)[inner]).max() < 1e-13 * abs(force).max()


@pytest.mark.parametrize("cell", CELLS)
def test_a_pulled_block_has_the_strain_of_its_traction(cell: str) -> None:
    mesh = mixed(cell)
    sides = ("left", "bottom", "front") if mesh.dim == 3 else ("left", "bottom")
    supports = tuple(
        sw.Fixed(on=side, components="xzy"[k] if mesh.dim == 3 else "xy"[k]) for k, side in enumerate(sides)
    )
    pull = sw.Traction(on="body.right", value=(0.1, 0.0, 0.0)[: mesh.dim])
    body = solid(mesh, supports=supports, **({} if mesh.dim == 3 else {"section": sw.bodies.PlaneStress()}))
    model = build(sw.Scene(bodies={"body": body}, loads=(pull,), start=StaticStart()))
    (step,) = sw.march(model, until=0.1, step=0.1)
    found = step.before.displacement["body"]
    exact = mesh.points * np.array([0.1, -0.03, -0.03])[: mesh.dim]
    assert found == pytest.approx(exact, abs=1e-12)
    followed(mesh, found)


@pytest.mark.parametrize("cell", ["quad4", "quad9", "hex8", "hex20"])
def test_supports_of_edges_with_hanging_nodes(cell: str) -> None:
    """Driven, held and inclined supports: nodes that hang between driven ones move with them."""
    mesh = mixed(cell)
    assert mesh.hanging is not None
    top = np.isin(mesh.hanging.parents, mesh.nodes("top")) & (mesh.hanging.weights != 0.0)
    assert (top.any(axis=1) & ~(top | (mesh.hanging.weights == 0.0)).all(axis=1)).any()  # some parents are driven
    law = sw.NeoHookean(E=1.0, nu=0.3)
    drive = sw.Driven(on="top", components="y", velocity=(0.0, 0.2, -0.1), times=(0.0, 0.3, 0.7))
    along = sw.Driven(on="top", direction=(1.0, 1.0, 0.0)[: mesh.dim], velocity=0.1)
    for driven in (drive, along):
        body = solid(mesh, material=law, supports=(driven, sw.Fixed(on="left", components="x")))
        steps = list(sw.march(build(sw.Scene(bodies={"body": body})), until=1.0, step=0.05))
        last = steps[-1]
        u, v = last.after.displacement["body"], last.after.velocity["body"]
        followed(mesh, u)
        followed(mesh, v)
        assert not abs(u[mesh.nodes("left"), 0]).max() if driven is drive else True
        scale = last.ledger.energy_kinetic + last.ledger.energy_strain
        assert max(abs(step.ledger.energy_error) for step in steps) < 1e-12 * scale
        moved = u[mesh.nodes("top")]
        if driven is drive:
            assert moved[:, 1] == pytest.approx(np.full(len(moved), 0.02), abs=1e-13)
        else:
            free = np.setdiff1d(mesh.nodes("top"), mesh.nodes("left"))
            assert u[free, :2].sum(axis=1) / np.sqrt(2.0) == pytest.approx(np.full(len(free), 0.1), abs=1e-13)


def test_contact_nodes_on_which_nodes_hang_are_refused() -> None:
    base = rectangle((1.0, 1.0), (4, 4))
    found = refined(base, 2 * (np.arange(16) == 0))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.1), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("body.bottom", "floor"))
    with pytest.raises(InputError, match="hanging nodes at contact nodes") as refusal:
        build(sw.Scene(bodies={"body": solid(found.mesh), "floor": floor}, contacts=(contact,)))
    assert "even" in refusal.value.remedy
    level = even(found, ["bottom"]).mesh
    assert build(sw.Scene(bodies={"body": solid(level), "floor": floor}, contacts=(contact,))).parts


def tied(mesh: Mesh) -> sw.Scene:
    """A block on a mesh on another block."""
    other = solid(rectangle((1.0, 1.0), (2, 2), origin=(0.0, -1.0)))
    return sw.Scene(bodies={"body": solid(mesh), "other": other}, ties=(sw.Tie(between=("body.bottom", "other.top")),))


def test_tied_nodes_on_which_nodes_hang_are_refused() -> None:
    found = refined(rectangle((1.0, 1.0), (2, 2)), np.array([0, 2, 0, 0]))
    with pytest.raises(InputError, match="hanging nodes at tied nodes") as refusal:
        build(tied(found.mesh))
    assert "even" in refusal.value.remedy
    model = build(tied(even(found, ["bottom"]).mesh))
    field = 0.01 * model.points @ np.array([[1.0, 0.3], [0.2, -0.5]])
    assert model.dofs.nodes(model.dofs.unknowns(field)) == pytest.approx(field, abs=1e-15)
    force = model.force(field)
    inner = ~(np.isclose(model.points, model.points.min(axis=0)) | np.isclose(model.points, model.points.max(axis=0)))
    gathered = model.dofs.gathered(force)[inner.all(axis=1)]
    assert abs(gathered).max() < 1e-13 * abs(force).max()


def test_thin_walls_are_refused() -> None:
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.1), normal=(0.0, 1.0)))
    wall = refined(
        rectangle((3.0, 0.1), (3, 1)).with_tag("end", lambda x: (x[:, 0] < 1.1) & (x[:, 1] == 0.0)), np.array([0, 0, 2])
    )
    contact = sw.Contact(between=("body.end", "floor"))
    with pytest.raises(InputError, match="hanging nodes, and") as refusal:
        sw.build(sw.Scene(bodies={"body": solid(wall.mesh), "floor": floor}, contacts=(contact,)))
    assert refusal.value.where == "bodies.body.mesh"
