"""NGSolve: trapezoidal rule, neo-Hookean energy, Newton's method with sparse Cholesky, ``ContactBoundary``."""

import netgen.meshing as netgen
import ngsolve as ng
import numpy as np
from cube import DENSITY, FACES, LAMBDA, MU, SPEED, Clock, chosen, lattice, slab
from netgen.csg import Pnt


def meshed(n, gap=None):
    """The cube with the boundaries ``lower`` and ``free``; with a ``gap`` the block with ``plane`` and ``rest`` too."""
    points, cubes = lattice(n)
    block = np.arange(8) + len(points)
    mesh = netgen.Mesh(dim=3)
    everything = points if gap is None else np.vstack([points, slab(gap)])
    numbers = [mesh.Add(netgen.MeshPoint(Pnt(*map(float, p)))) for p in everything]
    parts = {"lower": 1, "free": 1} | ({} if gap is None else {"plane": 2, "rest": 2})
    faces = {}
    for k, (name, part) in enumerate(parts.items()):
        faces[name] = mesh.Add(netgen.FaceDescriptor(bc=k + 1, domin=part, domout=0, surfnr=k + 1))
        mesh.SetBCName(k, name)
    mesh.SetMaterial(1, "cube")
    for c in cubes:
        mesh.Add(netgen.Element3D(1, [numbers[i] for i in c]))
    if gap is not None:
        mesh.SetMaterial(2, "block")
        mesh.Add(netgen.Element3D(2, [numbers[i] for i in block]))
    for side, corners in enumerate(FACES):
        quads = cubes[:, corners]
        middle = points[quads].mean(axis=1)
        outside = np.abs(middle - 0.5).max(axis=1) > 0.5 - 1e-9
        for quad in quads[outside]:
            mesh.Add(netgen.Element2D(faces["lower" if side == 0 else "free"], [numbers[i] for i in quad]))
        if gap is not None:
            mesh.Add(netgen.Element2D(faces["plane" if side == 1 else "rest"], [numbers[i] for i in block[corners]]))
    return ng.Mesh(mesh), len(points)


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    ng.SetNumThreads(ask.threads)
    mesh, count = meshed(ask.cells, ask.gap)
    clock, h = Clock(), ask.step
    space = ng.VectorH1(mesh, order=1, dirichlet="plane|rest")
    free, u = space.FreeDofs(), space.TrialFunction()
    shift, velocity, acceleration, predicted = (ng.GridFunction(space) for _ in range(4))
    vertical = 2 * (space.ndof // 3) + np.arange(count)
    velocity.vec.FV().NumPy()[vertical] = -SPEED

    def strain(w):
        F = ng.Id(3) + ng.Grad(w)
        J = ng.Det(F)
        return MU / 2 * (ng.Trace(F.trans * F) - 3) - MU * ng.log(J) + LAMBDA / 2 * ng.log(J) ** 2

    def kinetic(w):
        return DENSITY / 2 * ng.InnerProduct(w, w)

    form = ng.BilinearForm(space, symmetric=True)
    form += ng.Variation(strain(u).Compile() * ng.dx("cube"))
    form += ng.Variation(4 / h**2 * kinetic(u - predicted) * ng.dx("cube"))
    contact = ng.ContactBoundary(mesh.Boundaries("lower"), mesh.Boundaries("plane"))
    place = ng.CF((ng.x, ng.y, ng.z))
    depth = (place + u - place.Other() - u.Other()) * ng.CF((0, 0, -1))
    contact.AddEnergy(ng.IfPos(depth, ask.penalty / 2 * depth * depth, 0))
    rest, change, old = (shift.vec.CreateVector() for _ in range(3))
    mask = np.array([free[i] for i in range(space.ndof)])

    def step():
        with ng.TaskManager():
            predicted.vec.data = shift.vec + h * velocity.vec + h**2 / 4 * acceleration.vec
            contact.Update(shift, form, 0, 0.3)
            for _ in range(20):
                form.Apply(shift.vec, rest)
                if np.linalg.norm(rest.FV().NumPy()[mask]) < 1e-7:
                    break
                form.AssembleLinearization(shift.vec)
                change.data = form.mat.Inverse(free, inverse="sparsecholesky") * rest
                shift.vec.data -= change
            old.data = acceleration.vec
            acceleration.vec.data = 4 / h**2 * (shift.vec - predicted.vec)
            velocity.vec.data += h / 2 * (old + acceleration.vec)

    ones = ng.GridFunction(space)
    ones.vec.FV().NumPy()[vertical] = DENSITY
    weights = ng.LinearForm(ng.InnerProduct(ones, space.TestFunction()) * ng.dx("cube")).Assemble().vec
    before = -SPEED
    for k in range(round(ask.end / h)):
        clock.step(step)
        momentum = ng.InnerProduct(weights, velocity.vec)
        touching = (lattice(ask.cells)[0][:, 2] + shift.vec.FV().NumPy()[vertical]).min() < -ask.gap - 1e-9
        clock.note((k + 1) * h, touching, momentum, (momentum - before) / h)
        before = momentum
    energy = ng.Integrate((strain(shift) + kinetic(velocity)) * ng.dx("cube"), mesh) / (DENSITY / 2 * SPEED**2)
    clock.told("NGSolve", ng.__version__, 3 * count, velocity.vec.FV().NumPy()[vertical].mean(), energy)


if __name__ == "__main__":
    main()
