"""A cup pressed from a billet: a punch with a sharp edge in a die, through new meshes of triangles."""

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality

DIE, PUNCH, DEPTH = 1.02, 0.7, 0.4


def cup(cells: int) -> sw.Scene:
    """Billet of J2 with the radius and height of one."""
    billet = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(cells, cells), cell="tri3"),
        material=sw.J2(E=1e3, nu=0.3, yield_stress=1.0, hardening=sw.laws.LinearHardening(modulus=1.0)),
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="corner",
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
        remesh="auto",
    )
    die = sw.Tool(shape=sw.obstacles.HalfSpace(point=(DIE, 0.0), normal=(-1.0, 0.0)))
    punch = sw.Tool(
        shape=sw.obstacles.Block(low=(-1.0, 1.0), high=(PUNCH, 3.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    contacts = (sw.Contact(between=("billet.right", "die")), sw.Contact(between=("billet.top", "punch")))
    bodies = {"billet": billet, "die": die, "punch": punch}
    return sw.Scene(bodies=bodies, contacts=contacts, inertia=sw.bodies.Off())


@pytest.mark.slow
def test_a_cup_of_forty_per_cent() -> None:
    """The wall has the height of its volume, and new meshes keep cells, volume and energy."""
    steps = list(sw.march(cup(8), until=DEPTH, step=0.01))
    x = steps[-1].model.points + steps[-1].after.displacement["billet"]
    new = [one.exchanges["billet"] for one in steps if one.exchanges]
    assert steps[-1].after.time == pytest.approx(DEPTH)
    assert len(new) >= 2
    assert max(abs(one.volume) for one in new) < 1e-12
    assert abs(steps[-1].ledger.remeshing) < 1e-12 * steps[-1].ledger.work_external
    rim = (1.0 - DIE**2 * (1.0 - DEPTH)) / (DIE**2 - PUNCH**2) + 1.0 - DEPTH
    top = x[x[:, 1] > rim - 0.1]
    assert 0.5 * (top[:, 1].max() + np.partition(top[:, 1], -3)[-3]) == pytest.approx(rim, rel=4e-2)
    mesh = steps[-1].model.parts[0].mesh
    assert cell_quality(mesh.blocks, x).worst[0] > 0.2
