"""A cup pressed from a billet: a punch with a sharp edge in a die, through new meshes of triangles."""

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.adaptivity.unrelated.memory import present_volumes
from softway.arrays import Array

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
    loss, elastic = compressed(steps[-1], x)
    assert loss > 1e-3
    assert loss == pytest.approx(elastic, abs=1e-4)


def compressed(step: sw.Step, x: Array) -> tuple[float, float]:
    """What a cup has lost of its volume, and the elastic compression by its mean stress, relative to its volume."""
    part, start = step.model.parts[0], step.march_state.state.start
    state = start.states[0]
    assert state is not None
    volume = volume_of(part.mesh.blocks, part.internal.section, x)
    pressure = -np.trace(state.stress, axis1=1, axis2=2) / 3.0
    bulk = 1e3 / (3.0 * (1.0 - 2.0 * 0.3))
    elastic = float((present_volumes(part, start.displacement) * pressure).sum()) / bulk
    return 1.0 - volume / np.pi, elastic / np.pi


@pytest.mark.slow
@pytest.mark.minutes
def test_drops_of_the_force_fall_with_the_size_of_the_cells() -> None:
    """First slabs on new meshes against the line through the two slabs before: a coarse mesh in which the edge of the
    punch cuts into a side carries too much before its change.
    """
    greatest = []
    for cells in (8, 16):
        steps = list(sw.march(cup(cells), until=DEPTH, step=0.01))
        force = [one.ledger.contacts["billet.top-punch"].force_n for one in steps]
        time = [0.5 * (one.before.time + one.after.time) for one in steps]
        off = []
        for k in (k for k, one in enumerate(steps) if one.exchanges):
            slope = (force[k - 1] - force[k - 2]) / (time[k - 1] - time[k - 2])
            off.append(abs(force[k] / (force[k - 1] + slope * (time[k] - time[k - 1])) - 1.0))
        greatest.append(max(off))
        assert force[-1] == pytest.approx(10.3, rel=0.06)
    assert greatest[1] < 0.06 < 0.2 * greatest[0]
