"""NGSolve on two blocks: ``ContactBoundary`` between them, compiled strain energy, a factor kept while it contracts.

The energy of the contact is a penalty on the depth of each point of integration of the upper face under the opposite
point of the lower block; pairs are found anew in every step.  ``--kept 0`` factors in every iteration, as tutorials do.
"""

from functools import partial

import netgen.meshing as netgen
import ngsolve as ng
import numpy as np
from blocks import chosen, faces, lower, upper
from cube import Clock
from netgen.csg import Pnt
from ngsolve_steps import Motion, density, inertia

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


def tangent(form, share, mass, scale):
    """The matrix of an iteration: pairs of the contact couple unknowns outside the pattern of the mass."""
    return (share * form.mat + scale * mass).CreateSparseMatrix()


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    ng.SetNumThreads(ask.threads)
    clock, mesh = Clock(), meshed(ask.cells)
    space = ng.VectorH1(mesh, order=1)
    u, count = space.TrialFunction(), space.ndof // 3
    form = ng.BilinearForm(space, symmetric=True)
    form += ng.Variation(density(u).Compile() * ng.dx)
    contact = ng.ContactBoundary(mesh.Boundaries("bottom"), mesh.Boundaries("top"))
    place = ng.CF((ng.x, ng.y, ng.z))
    depth = (place + u - place.Other() - u.Other()) * contact.normal
    contact.AddEnergy(ng.IfPos(depth, ask.penalty / 2 * depth * depth, 0))
    above = 2 * count + np.arange(len(lower(ask.cells)[0]), count)
    motion = Motion(ask, form, inertia(space, ask.mass), above, tangent, ask.kept)
    whole = ng.InnerProduct(motion.weights, motion.ones)
    for k in range(round(ask.end / ask.step)):
        clock.step(partial(motion.step, lambda shift: contact.Update(shift, form, ask.order, REACH)))
        clock.note((k + 1) * ask.step, False, motion.momentum / whole, 0.0)
    clock.told("NGSolve", ng.__version__, space.ndof, motion.momentum / whole, None)


if __name__ == "__main__":
    main()
