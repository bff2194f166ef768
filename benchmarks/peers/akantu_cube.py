"""Akantu: explicit central differences, lumped mass, tetrahedra of its finite-strain elastic law, penalty contact."""

import os
import tempfile
from pathlib import Path

import akantu as aka
import numpy as np
from cube import DENSITY, NU, Clock, E, chosen, lattice, tetrahedra

MATERIALS = """
material elastic [
  name = cube
  rho = {density}
  E = {E}
  nu = {nu}
  finite_deformation = 1
]
material elastic [
  name = block
  rho = {density}
  E = {E}
  nu = {nu}
]
contact_detector [
  type = explicit
  master = plane
  slave = lower
  projection_tolerance = 1e-10
  max_iterations = 100
  extension_tolerance = 1e-5
]
contact_resolution penalty_linear [
  name = touch
  mu = 0.0
  epsilon_n = {penalty}
  epsilon_t = {penalty}
  is_master_deformable = false
]
"""
SAFETY = 0.5
"""Step over the stable one of the bulk; the penalty makes it shorter."""


def block(n, gap):
    """Corners (p, 3) and cells (e, 8) of a block below the cube: a layer of cells as wide as those of the cube.

    Akantu looks for the plane only in the faces at the node that is next to that of the cube: with faces wider than
    those of the cube it finds no contact for many nodes.  The layer is moved aside, so that no node lies on an edge.
    """
    points, cells = lattice(n + 4)
    layer = cells[points[cells, 2].min(axis=1) == 0.0]
    used, local = np.unique(layer, return_inverse=True)
    corners = points[used] * (n + 4) / n - np.array([1.63, 1.74, 0.0]) / n
    corners[:, 2] = np.where(corners[:, 2] > 0.0, -gap, -gap - 0.25)
    return corners, local.reshape(layer.shape)


def written(n, gap, file):
    """Write the mesh, and give the number of points of the cube."""
    points, cubes = lattice(n)
    corners, blocks = block(n, gap)
    everything = np.vstack([points, corners])
    bulk, plate = tetrahedra(cubes), tetrahedra(blocks + len(points))

    def sides(cells, height):
        faces = cells[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]].reshape(-1, 3)
        return faces[(np.abs(everything[faces, 2] - height) < 1e-12).all(axis=1)]

    groups = [(2, 1, sides(bulk, 0.0)), (2, 2, sides(plate, -gap)), (4, 3, bulk), (4, 4, plate)]
    rows = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "4"]
    rows += ['2 1 "lower"', '2 2 "plane"', '3 3 "cube"', '3 4 "block"', "$EndPhysicalNames"]
    rows += ["$Nodes", str(len(everything))]
    rows += [f"{k} {p[0]:.15g} {p[1]:.15g} {p[2]:.15g}" for k, p in enumerate(everything, 1)]
    rows += ["$EndNodes", "$Elements", str(sum(len(cells) for _, _, cells in groups))]
    cells = [(kind, group, cell) for kind, group, part in groups for cell in part + 1]
    rows += [f"{k} {kind} 2 {group} {group} {' '.join(map(str, c))}" for k, (kind, group, c) in enumerate(cells, 1)]
    file.write_text("\n".join([*rows, "$EndElements", ""]))
    return len(points)


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        count = written(ask.cells, ask.gap, Path("cube.msh"))
        Path("cube.dat").write_text(MATERIALS.format(density=DENSITY, E=E, nu=NU, penalty=ask.penalty))
        aka.parseInput("cube.dat")
        mesh = aka.Mesh(3)
        mesh.read("cube.msh")
        os.chdir("/")
    clock = Clock()
    both = aka.CouplerSolidContact(mesh)
    solid, contact = both.getSolidMechanicsModel(), both.getContactMechanicsModel()
    solid.setMaterialSelector(aka.MeshDataMaterialSelectorString("physical_names", solid))
    both.initFull(_analysis_method=aka._explicit_lumped_mass)
    contact.getContactDetector().setSurfaceSelector(aka.PhysicalSurfaceSelector(mesh))
    for axis in (aka._x, aka._y, aka._z):
        solid.applyBC(aka.FixedValue(0.0, axis), "block")
    step = SAFETY * solid.getStableTimeStep()
    both.setTimeStep(step)
    velocity, shift = solid.getVelocity(), solid.getDisplacement()
    velocity[:count, 2] = -ask.speed
    points, cubes = lattice(ask.cells)
    height, cells = points[:, 2], tetrahedra(cubes)
    weights = np.bincount(cells.ravel(), minlength=count) * DENSITY / (4 * len(cells))
    solid.getExternalForce()[:count, 2] = -ask.load * weights
    solid.getAcceleration()[:count, 2] = -ask.load
    before = -ask.speed
    for k in range(round(ask.end / step)):
        clock.step(both.solveStep)
        momentum = weights @ velocity[:count, 2]
        lowest = (height + shift[:count, 2]).min()
        clock.sunk(-ask.gap - lowest)
        touching = lowest < -ask.gap - 1e-9
        clock.note((k + 1) * step, touching, momentum, (momentum - before) / step)
        before = momentum
    clock.told("Akantu", getattr(aka, "__version__", "5"), 3 * count, velocity[:count, 2].mean(), None)


if __name__ == "__main__":
    main()
