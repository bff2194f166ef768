"""NGSolve on two blocks: ``ContactBoundary`` between them, compiled strain energy, a factor kept while it contracts.

The energy of the contact is a penalty on the depth of each point of integration of the upper face under the opposite
point of the lower block; pairs are found anew in every step.  ``--kept 0`` factors in every iteration, as tutorials do.
"""

import netgen.meshing as netgen
import ngsolve as ng
import numpy as np
from blocks import chosen, faces, lower, upper
from cube import RESIDUAL, SPEED, Clock, Newmark, in_pattern
from netgen.csg import Pnt
from ngsolve_expert import density

REACH = 0.05
"""Distance within which opposite points are sought [m]."""


def meshed(n):
    """Both blocks, with the boundaries ``top`` of the lower one and ``bottom`` of the upper one."""
    mesh, start = netgen.Mesh(dim=3), 0
    sides = (("top", 1), ("bottom", 0))
    for part, ((points, cubes), (name, side)) in enumerate(zip((lower(n), upper(n)), sides, strict=True), 1):
        numbers = [mesh.Add(netgen.MeshPoint(Pnt(*map(float, p)))) for p in points]
        mesh.SetMaterial(part, ("below", "above")[part - 1])
        for c in cubes:
            mesh.Add(netgen.Element3D(part, [numbers[i] for i in c]))
        for boundary, quads in ((name, faces(cubes, side)), (f"rest{part}", faces(cubes, side, True))):
            start += 1
            face = mesh.Add(netgen.FaceDescriptor(bc=start, domin=part, domout=0, surfnr=start))
            mesh.SetBCName(start - 1, boundary)
            for quad in quads:
                mesh.Add(netgen.Element2D(face, [numbers[i] for i in quad]))
    return ng.Mesh(mesh)


def inertia(space, file):
    """The consistent mass matrix, or with a ``file`` that of the file, in the same pattern."""
    u, w = space.TnT()
    matrix = ng.BilinearForm(ng.InnerProduct(u, w) * ng.dx, symmetric=True).Assemble().mat
    if file:
        rows, columns, _ = (np.array(part) for part in matrix.COO())
        count = space.ndof // 3
        values = in_pattern(file, rows % count, columns % count, count)
        matrix.AsVector().FV().NumPy()[:] = np.where(rows // count == columns // count, values, 0.0)
    return matrix


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    ng.SetNumThreads(ask.threads)
    clock, h, rule = Clock(), ask.step, Newmark.of(ask.radius)
    mesh = meshed(ask.cells)
    space = ng.VectorH1(mesh, order=1)
    u, count = space.TrialFunction(), space.ndof // 3
    form = ng.BilinearForm(space, symmetric=True)
    form += ng.Variation(density(u).Compile() * ng.dx)
    contact = ng.ContactBoundary(mesh.Boundaries("bottom"), mesh.Boundaries("top"))
    place = ng.CF((ng.x, ng.y, ng.z))
    depth = (place + u - place.Other() - u.Other()) * contact.normal
    contact.AddEnergy(ng.IfPos(depth, ask.penalty / 2 * depth * depth, 0))
    mass = inertia(space, ask.mass)
    shift = ng.GridFunction(space)
    now, older, velocity, acceleration, predicted, end = (mass.CreateColVector() for _ in range(6))
    inner, before, rest, pull = (mass.CreateColVector() for _ in range(4))
    above = 2 * count + np.arange(len(lower(ask.cells)[0]), count)
    now[:], velocity[:], acceleration[:], before[:] = 0.0, 0.0, 0.0, 0.0
    velocity.FV().NumPy()[above] = -SPEED
    older.data = -h * velocity
    ones, weights = mass.CreateColVector(), mass.CreateColVector()
    ones[:] = 0.0
    ones.FV().NumPy()[above] = 1.0
    weights.data = mass * ones
    whole = ng.InnerProduct(weights, ones)
    scale = (1.0 - rule.am) / (rule.beta * h**2)
    factor = {}

    def residual():
        form.Apply(shift.vec, inner)
        end.data = 1.0 / (rule.beta * h**2) * (shift.vec - predicted)
        pull.data = (1.0 - rule.am) * end + rule.am * acceleration
        rest.data = mass * pull + (1.0 - rule.af) * inner + rule.af * before
        return np.linalg.norm(rest.FV().NumPy())

    def factorised():
        form.AssembleLinearization(shift.vec)
        tangent = ((1.0 - rule.af) * form.mat + scale * mass).CreateSparseMatrix()
        factor["inverse"] = tangent.Inverse(inverse="sparsecholesky")

    def step():
        with ng.TaskManager():
            predicted.data = now + h * velocity + h**2 * (0.5 - rule.beta) * acceleration
            shift.vec.data = 2.0 * now - older
            older.data = now
            contact.Update(shift, form, ask.order, REACH)
            size = residual()
            for _ in range(40):
                if size < RESIDUAL:
                    break
                if not factor:
                    factorised()
                shift.vec.data -= factor["inverse"] * rest
                was, size = size, residual()
                if size > ask.kept * was:
                    factor.clear()
            velocity.data += h * (1.0 - rule.gamma) * acceleration + h * rule.gamma * end
            now.data, acceleration.data, before.data = shift.vec, end, inner

    for k in range(round(ask.end / h)):
        clock.step(step)
        clock.note((k + 1) * h, False, ng.InnerProduct(weights, velocity) / whole, 0.0)
    mean = ng.InnerProduct(weights, velocity) / whole
    clock.told("NGSolve", ng.__version__, space.ndof, mean, None)


if __name__ == "__main__":
    main()
