"""NGSolve by an expert: compiled forms, the plane as an energy of the boundary, a factor kept while it contracts.

With ``--mass`` the inertia is that of a given matrix, say one in which the nodes of the contact have none.
"""

import ngsolve as ng
import numpy as np
from cube import DENSITY, ENERGY, Clock, chosen, lattice
from ngsolve_cube import meshed
from ngsolve_steps import Motion, density, inertia

KEPT = 0.1
"""Part to which an iteration has to reduce the residual for its factor to be kept."""


def tangent(form, share, mass, scale):
    """The matrix of an iteration, in the pattern of the mass and in the memory of the form."""
    values = form.mat.AsVector()
    values.data = share * values + scale * mass.AsVector()
    return form.mat


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    ng.SetNumThreads(ask.threads)
    mesh, count = meshed(ask.cells)
    clock = Clock()
    space = ng.VectorH1(mesh, order=1)
    u = space.TrialFunction()
    depth = -(ng.z + u[2] + ask.gap)
    form = ng.BilinearForm(space, symmetric=True)
    form += ng.Variation(density(u).Compile() * ng.dx)
    form += ng.Variation(ng.IfPos(depth, ask.penalty / 2 * depth * depth, 0).Compile() * ng.ds("lower"))
    if ask.load:
        form += ng.Variation((DENSITY * ask.load * u[2]).Compile() * ng.dx)
    mass = inertia(space, ask.mass)
    vertical = 2 * (space.ndof // 3) + np.arange(count)
    motion = Motion(ask, form, mass, vertical, tangent, KEPT)
    motion.acceleration.FV().NumPy()[vertical] = -ask.load
    lower = lattice(ask.cells)[0][:, 2]
    below = -(ng.z + ng.BoundaryFromVolumeCF(motion.shift)[2] + ask.gap)
    pressing = ng.IfPos(below, ask.penalty * below, 0)
    for k in range(round(ask.end / ask.step)):
        clock.step(motion.step)
        height = (lower + motion.place.FV().NumPy()[vertical]).min()
        force = ng.Integrate(pressing * ng.ds("lower"), mesh) if height < -ask.gap else 0.0
        clock.sunk(-ask.gap - height)
        clock.note((k + 1) * ask.step, height < -ask.gap - 1e-9, motion.momentum, force)
    kinetic = 0.5 * ng.InnerProduct(motion.velocity, (mass * motion.velocity).Evaluate())
    stored = ng.Integrate(density(motion.shift) * ng.dx, mesh)
    mean = motion.velocity.FV().NumPy()[vertical].mean()
    clock.told("NGSolve", ng.__version__, space.ndof, mean, (stored + kinetic) / ENERGY)


if __name__ == "__main__":
    main()
