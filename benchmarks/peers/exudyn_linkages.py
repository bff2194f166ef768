"""Exudyn: the slider-crank of case F04 and the four-bar loops of F03, by generalized alpha in minimal planar bodies.

``python exudyn_linkages.py CASE STEP STEPS`` prints a line of JSON; CASE is ``crank`` or the number of loops.
"""

import json
import sys
from time import process_time

import exudyn as exu
from exudyn.utilities import (
    LoadMassProportional,
    MarkerBodyMass,
    MarkerBodyRigid,
    NodeRigidBody2D,
    ObjectGround,
    ObjectJointPrismatic2D,
    ObjectJointRevolute2D,
    ObjectRigidBody2D,
)

RADIUS = 0.9
"""Spectral radius of the integrator."""
SPARSE = 10
"""Loops from which the sparse solver is the faster one."""


class Scene:
    """Planar bodies and joints of a system."""

    def __init__(self):
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.ground = self.system.AddObject(ObjectGround())

    def body(self, mass, inertia, centre, velocity=(0.0, 0.0, 0.0), turned=0.0):
        """Body and node of a body with weight."""
        node = self.system.AddNode(
            NodeRigidBody2D(referenceCoordinates=[*centre, turned], initialVelocities=list(velocity))
        )
        body = self.system.AddObject(ObjectRigidBody2D(nodeNumber=node, physicsMass=mass, physicsInertia=inertia))
        marker = self.system.AddMarker(MarkerBodyMass(bodyNumber=body))
        self.system.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=[0.0, -9.81, 0.0]))
        return body, node

    def marker(self, body, x, y=0.0):
        """Marker at a point of a body."""
        return self.system.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0.0]))

    def hinge(self, one, other):
        """Hinge between two points, each a body and its coordinates there."""
        self.system.AddObject(ObjectJointRevolute2D(markerNumbers=[self.marker(*one), self.marker(*other)]))


def crank():
    """Uniform rods in a line, and a slider; the node of the crank."""
    scene, r, length, spin, mass = Scene(), 0.153, 0.306, 150.0, 0.038
    first, node = scene.body(mass, mass * r**2 / 12.0, (0.5 * r, 0.0), (0.0, 0.5 * r * spin, spin))
    way = (0.0, 0.5 * r * spin, -r * spin / length)
    second, _ = scene.body(mass, mass * length**2 / 12.0, (r + 0.5 * length, 0.0), way)
    slider, _ = scene.body(0.076, 1e-5, (r + length, 0.0))
    scene.hinge((scene.ground, 0.0), (first, -0.5 * r))
    scene.hinge((first, 0.5 * r), (second, -0.5 * length))
    scene.hinge((second, 0.5 * length), (slider, 0.0))
    markers = [scene.marker(scene.ground, 0.0), scene.marker(slider, 0.0)]
    scene.system.AddObject(ObjectJointPrismatic2D(markerNumbers=markers))
    return scene, node


def loops(count):
    """Upright cranks that couplers connect at their tops; the node of the first crank."""
    scene, cranks, half = Scene(), [], 0.5
    for k in range(count + 1):
        cranks.append(scene.body(1.0, 1.0 / 12.0, (float(k), half), (0.5, 0.0, -1.0)))
        scene.hinge((scene.ground, float(k)), (cranks[-1][0], 0.0, -half))
    for k in range(count):
        coupler, _ = scene.body(1.0, 1.0 / 12.0, (k + half, 1.0), (1.0, 0.0, 0.0))
        scene.hinge((cranks[k][0], 0.0, half), (coupler, -half))
        scene.hinge((cranks[k + 1][0], 0.0, half), (coupler, half))
    return scene, cranks[0][1]


def main():
    """Run, and print a line of JSON."""
    case, step, steps = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
    best = None
    for modified in (False, True):
        scene, node = crank() if case == "crank" else loops(int(case))
        scene.system.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = steps * step
        settings.timeIntegration.generalizedAlpha.spectralRadius = RADIUS
        settings.timeIntegration.newton.useModifiedNewton = modified
        settings.timeIntegration.verboseMode = 0
        settings.solutionSettings.writeSolutionToFile = False
        settings.displayComputationTime = False
        if case != "crank" and int(case) >= SPARSE:
            settings.linearSolverType = exu.LinearSolverType.EigenSparse
        start = process_time()
        try:
            scene.system.SolveDynamic(settings)
        except Exception as problem:  # where one Newton's method fails the other counts
            print(problem, file=sys.stderr)
            continue
        used = process_time() - start
        angle = scene.system.GetNodeOutput(node, exu.OutputVariableType.Coordinates)[2]
        if best is None or used < best["used"]:
            best = {"used": used, "angle": float(angle), "modified": modified, "version": exu.__version__}
    print(json.dumps(best))


if __name__ == "__main__":
    main()
