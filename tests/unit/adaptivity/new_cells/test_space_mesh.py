"""New tetrahedra within a boundary: volume, tags, quality; and Mmg where it is installed."""

import builtins
from typing import Any

import numpy as np
import pytest

from softway.adaptivity.new_cells.mmg import mmg, mmg_tetrahedra, mmg_triangles
from softway.adaptivity.new_cells.plane_mesh import plane_mesh
from softway.adaptivity.new_cells.sizes import edge_lengths
from softway.adaptivity.new_cells.space_mesh import Improver, improved_tetrahedra, space_mesh
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.arrays import Array
from softway.bodies.elements.section import Volume
from softway.errors import InputError
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh


def barrel(mesh: Mesh) -> Array:
    """A cube pressed to half its height, with bulging sides, and its inner nodes moved badly."""
    x = np.array(mesh.points)
    x[:, :2] = 0.5 + (x[:, :2] - 0.5) * (1.4 - 0.4 * (2.0 * x[:, 2:] - 1.0) ** 2)
    x[:, 2] *= 0.5
    if "tet4" in mesh.blocks:
        inside = np.setdiff1d(np.arange(len(x)), mesh.nodes("surface"))
        x[inside, 0] += 0.1
    return x


def check(cell: str, improve: Improver, better: float) -> None:
    mesh = box((1.0, 1.0, 1.0), cells=(4, 4, 4), cell=cell)
    places, none = barrel(mesh), np.zeros(mesh.n_nodes, dtype=bool)
    found = space_mesh(mesh, places, edge_lengths(mesh), none, none, improve)
    assert found is not None
    new = found.mesh
    volumes = [volume_of(m.blocks, Volume(), x) for m, x in ((mesh, places), (new, new.points))]
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-13)
    quality = [cell_quality(m.blocks, x).worst[0] for m, x in ((mesh, places), (new, new.points))]
    assert quality[1] > better * quality[0]
    for tag in mesh.tags:
        rows = [np.unique(x.round(12), axis=0) for x in (places[mesh.nodes(tag)], new.points[new.nodes(tag)])]
        assert np.array_equal(*rows)
    assert new.n_cells == pytest.approx(mesh.n_cells, rel=0.6)


@pytest.mark.parametrize("cell", ["tet4", "tet10"])
def test_own_tetrahedra(cell: str) -> None:
    check(cell, improved_tetrahedra, 1.0)


@pytest.mark.parametrize("cell", ["tet4", "tet10"])
def test_tetrahedra_by_mmg(cell: str) -> None:
    pytest.importorskip("mmgpy")
    check(cell, mmg_tetrahedra, 0.9)


@pytest.mark.parametrize("cell", ["tri3", "tri6"])
def test_triangles_by_mmg(cell: str) -> None:
    pytest.importorskip("mmgpy")
    mesh = rectangle((1.0, 1.0), cells=(8, 8), cell=cell)
    none = np.zeros(mesh.n_nodes, dtype=bool)
    found = plane_mesh(mesh, mesh.points, edge_lengths(mesh), none, none, mmg_triangles)
    assert found is not None
    assert cell_quality(found.mesh.blocks, found.mesh.points).worst[0] > 0.5
    assert len(found.mesh.nodes("top")) == len(found.mesh.nodes("left"))


def test_without_mmg_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *args: Any, **options: Any) -> Any:
        if name == "mmgpy":
            raise ImportError(name)
        return real(name, *args, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"softway\[remesh\]"):
        mmg()
