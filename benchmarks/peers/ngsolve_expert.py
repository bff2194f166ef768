"""NGSolve by an expert: compiled forms, the plane as an energy of the boundary, a factor kept while it contracts.

With ``--mass`` the inertia is that of a given matrix, say one in which the nodes of the contact have none.
"""

import ngsolve as ng
import numpy as np
from cube import DENSITY, ENERGY, LAMBDA, MU, RESIDUAL, SPEED, Clock, Newmark, chosen, in_pattern, lattice
from ngsolve_cube import meshed

KEPT = 0.1
"""Part to which an iteration has to reduce the residual for its factor to be kept."""


def density(w):
    """Strain energy of a displacement, per unit of volume."""
    F = ng.Id(3) + ng.Grad(w)
    J = ng.Det(F)
    return MU / 2 * (ng.Trace(F.trans * F) - 3) - MU * ng.log(J) + LAMBDA / 2 * ng.log(J) ** 2


def inertia(space, file):
    """The consistent mass matrix, or with a ``file`` that of the file, in the same pattern."""
    u, w = space.TnT()
    matrix = ng.BilinearForm(DENSITY * ng.InnerProduct(u, w) * ng.dx, symmetric=True).Assemble().mat
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
    mesh, count = meshed(ask.cells)
    clock, h, rule = Clock(), ask.step, Newmark.of(ask.radius)
    space = ng.VectorH1(mesh, order=1)
    u = space.TrialFunction()
    depth = -(ng.z + u[2] + ask.gap)
    form = ng.BilinearForm(space, symmetric=True)
    form += ng.Variation(density(u).Compile() * ng.dx)
    form += ng.Variation(ng.IfPos(depth, ask.penalty / 2 * depth * depth, 0).Compile() * ng.ds("lower"))
    mass = inertia(space, ask.mass)
    shift = ng.GridFunction(space)
    place, older, velocity, acceleration, predicted, end = (mass.CreateColVector() for _ in range(6))
    inner, before, rest, pull = (mass.CreateColVector() for _ in range(4))
    vertical = 2 * (space.ndof // 3) + np.arange(count)
    place[:], velocity[:], acceleration[:], before[:] = 0.0, 0.0, 0.0, 0.0
    velocity.FV().NumPy()[vertical] = -SPEED
    older.data = -h * velocity
    ones, weights = mass.CreateColVector(), mass.CreateColVector()
    ones[:] = 0.0
    ones.FV().NumPy()[vertical] = 1.0
    weights.data = mass * ones
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
        values = form.mat.AsVector()
        values.data = (1.0 - rule.af) * values + scale * mass.AsVector()
        factor["inverse"] = form.mat.Inverse(inverse="sparsecholesky")

    def step():
        with ng.TaskManager():
            predicted.data = place + h * velocity + h**2 * (0.5 - rule.beta) * acceleration
            shift.vec.data = 2.0 * place - older
            older.data = place
            size = residual()
            for _ in range(40):
                if size < RESIDUAL:
                    break
                if not factor:
                    factorised()
                shift.vec.data -= factor["inverse"] * rest
                was, size = size, residual()
                if size > KEPT * was:
                    factor.clear()
            velocity.data += h * (1.0 - rule.gamma) * acceleration + h * rule.gamma * end
            place.data, acceleration.data, before.data = shift.vec, end, inner

    lower = lattice(ask.cells)[0][:, 2]
    below = -(ng.z + ng.BoundaryFromVolumeCF(shift)[2] + ask.gap)
    pressing = ng.IfPos(below, ask.penalty * below, 0)
    for k in range(round(ask.end / h)):
        clock.step(step)
        height = (lower + place.FV().NumPy()[vertical]).min()
        force = ng.Integrate(pressing * ng.ds("lower"), mesh) if height < -ask.gap else 0.0
        clock.note((k + 1) * h, height < -ask.gap - 1e-9, ng.InnerProduct(weights, velocity), force)
    kinetic = 0.5 * ng.InnerProduct(velocity, (mass * velocity).Evaluate())
    stored = ng.Integrate(density(shift) * ng.dx, mesh)
    mean = velocity.FV().NumPy()[vertical].mean()
    clock.told("NGSolve", ng.__version__, space.ndof, mean, (stored + kinetic) / ENERGY)


if __name__ == "__main__":
    main()
