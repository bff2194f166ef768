"""New meshes of a solid that touches another one: their contact stays as it was."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.heat.coupled.build import build
from softway.marching.remeshing.forming.fitting import fitted_places
from softway.marching.remeshing.forming.formed_scene import formed_scene
from softway.meshes.mesh import Mesh
from softway.model.model import Model

PLASTIC = sw.J2(E=1.0, nu=0.3, yield_stress=0.05)


def pair() -> sw.Scene:
    """A block on a wider one; the upper one has the finer surface, of the sides .25 and .3."""
    upper = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4), origin=(-0.5, 0.0))
    lower = sw.meshes.Rectangle(size=(1.5, 1.0), cells=(5, 3), origin=(-0.75, -1.0))
    solids = {
        name: sw.Solid(mesh=mesh, material=PLASTIC, density=1.0, remesh="auto")
        for name, mesh in {"upper": upper, "lower": lower}.items()
    }
    return sw.Scene(bodies=solids, contacts=(sw.Contact(between=("lower.top", "upper.bottom")),))


def slave(model: Model) -> str:
    """Solid of the slaves of the first contact."""
    return model.parts[model.part_of[model.contacts.node[0]]].name


def wider(mesh: Mesh, factor: float) -> Mesh:
    """A mesh that is longer along x."""
    return replace(mesh, points=mesh.points * [factor, 1.0])


def test_slaves_stay_though_the_other_surface_gets_finer() -> None:
    first = formed_scene(sw.build(pair())).model
    upper = first.scene.bodies["upper"]
    assert isinstance(upper, sw.Solid)
    mesh = wider(first.meshes["upper"], 1.5)
    changed = replace(first.scene, bodies={**first.scene.bodies, "upper": replace(upper, mesh=mesh)})
    assert slave(first) == "upper"
    assert slave(sw.build(changed)) == "lower"
    assert slave(build(changed, first)) == "upper"


@pytest.mark.parametrize("kept", [False, True], ids=["free", "kept"])
def test_a_facet_that_moves_into_another_solid_moves_back(kept: bool) -> None:
    model = sw.build(pair())
    u, part = np.zeros(model.shape), next(p for p in model.parts if p.name == "lower")
    top = part.mesh.nodes("top")
    node = top[np.argmin(np.abs(part.mesh.points[top, 0] - 0.15))]
    places = np.array(part.mesh.points)
    places[node, 1] += 0.05
    none = np.zeros(len(places), dtype=bool)
    stays = none | kept
    found, pushed = fitted_places(model, u, 0.0, "lower", none, stays, places)
    assert pushed[node] != kept
    if kept:
        assert np.array_equal(found, places)
        return
    u[part.nodes] = found - part.mesh.points
    rows = model.rows(u, 0.0)
    assert rows.gap(u)[rows.near].min() > -1e-12
    assert not pushed[np.setdiff1d(np.arange(len(places)), top)].any()
    assert np.abs(found - places).max() <= 0.06
