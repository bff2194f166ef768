"""What frames hold beside the motion: history variables, pressure and traction of contact."""

import numpy as np
import pytest

import softway as sw

SHAPES = {
    "quad4": sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)),
    "tri6": sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2), cell="tri6"),
    "tet10": sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 1), cell="tet10"),
    "hex8": sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 1)),
}


def pressed(mesh, material, friction=None, sideways=0.0):
    """A unit block on a fixed bottom, pressed by a plate at speed 0.05 for one second without inertia."""
    d = len(mesh.size)
    up, last = (0.0,) * (d - 1) + (1.0,), "xyz"[d - 1]
    held = sw.Fixed(on="bottom", components=last)
    pinned = [sw.Fixed(on="left", components="x")] + ([sw.Fixed(on="front", components="y")] if d == 3 else [])
    block = sw.Solid(mesh=mesh, material=material, density=1.0, supports=(held, *pinned))
    plate = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=up, normal=tuple(-x for x in up)),
        motion=sw.bodies.Translation(velocity=(sideways,) + (0.0,) * (d - 2) + (-0.05,)),
    )
    law = {} if friction is None else {"friction": friction}
    contact = sw.Contact(between=("block.top", "plate"), **law)
    return sw.run(
        sw.Scenario(
            bodies={"block": block, "plate": plate},
            contacts=(contact,),
            inertia=sw.bodies.Off(),
            time=sw.Time(end=1.0, step=0.1),
        )
    )


@pytest.mark.parametrize("cell", SHAPES)
def test_the_pressure_of_a_pressed_block_is_its_stress(cell):
    """Also at the corners of quadratic triangles, around which there is no area."""
    run = pressed(SHAPES[cell], sw.LinearElastic(E=100.0, nu=0.3))
    frame, cells = run.fields[-1], run.fields.cells
    top = cells.reference[:, cells.dimension - 1] > 1.0 - 1e-9
    stress = -frame.stress[:, cells.dimension - 1]
    assert stress.min() > 4.0 and np.ptp(stress) < 1e-6 * stress.max()
    # small strain: the stress is that of the shape at the start, the pressure that of the present area
    area = np.prod(np.ptp(frame.points[top], axis=0)[: cells.dimension - 1])
    np.testing.assert_allclose(frame["contact_pressure"][top], frame.contact_force.sum() / area, rtol=1e-6)
    assert not frame["contact_pressure"][~top].any()
    assert set(run.fields.kinds) == {
        "displacement",
        "velocity",
        "contact_force",
        "contact_pressure",
        "stress",
        "von_mises",
    }


def test_plastic_strain_and_dissipation_of_a_crushed_block():
    """Perfectly plastic: logarithmic strain less yield stress over E, and yield stress times plastic strain."""
    run = pressed(SHAPES["hex8"], sw.J2(E=1000.0, nu=0.3, yield_stress=2.0))
    frame, kinds = run.fields[-1], run.fields.kinds
    plastic = -np.log(0.95) - 2.0 / 1000.0
    np.testing.assert_allclose(frame["plastic_strain"], plastic, rtol=5e-3)
    np.testing.assert_allclose(frame["dissipation"], 2.0 * plastic, rtol=1e-2)
    total = frame["dissipation"].mean()
    assert run.history["dissipation"][-1] == pytest.approx(total, rel=1e-9)
    assert kinds["plastic_strain"].unit == "" and kinds["dissipation"].unit == "J/m^3"
    assert kinds["plastic_strain"].on == "cells" and not run.fields[0]["plastic_strain"].any()


def test_a_sliding_plate_pulls_with_friction():
    run = pressed(SHAPES["quad4"], sw.LinearElastic(E=100.0, nu=0.3), sw.Coulomb(mu=0.2), sideways=1.0)
    frame = run.fields[-1]
    pressure, traction = frame["contact_pressure"], frame["tangential_traction"]
    assert pressure.max() > 4.0
    np.testing.assert_allclose(traction[:, 0], 0.2 * pressure, rtol=1e-6, atol=1e-9)
    assert not traction[:, 1:].any()
