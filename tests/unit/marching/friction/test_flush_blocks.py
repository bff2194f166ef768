"""A block falls on another one of the same width, aslant, with friction between the whole surfaces.

Faces, corners and edges of both meet at the same places: their rows depend on each other and are found otherwise from
slab to slab.
"""

import pytest

import softway as sw

pytestmark = pytest.mark.slow

RUBBER = sw.NeoHookean(E=1e6, nu=0.3)


def scene(above: int, below: int) -> sw.Scene:
    """Cubes of 1 m and so many cells to an edge, the lower one on its bottom."""
    return sw.Scene(
        bodies={
            "above": sw.Solid(
                mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(above,) * 3, origin=(0.0, 0.0, 1.0)),
                material=RUBBER,
                density=1000.0,
                velocity=sw.bodies.Uniform(value=(0.2, 0.0, -0.5)),
            ),
            "below": sw.Solid(
                mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(below,) * 3),
                material=RUBBER,
                density=1000.0,
                supports=(sw.Fixed(on="bottom"),),
            ),
        },
        contacts=(sw.Contact(between=("above", "below"), friction=sw.Coulomb(mu=0.3)),),
        loads=(sw.Gravity(acceleration=(0.0, 0.0, -9.81)),),
    )


@pytest.mark.parametrize(("above", "below"), [(3, 3), pytest.param(3, 4, marks=pytest.mark.minutes)])
def test_flush_blocks_slide_with_friction(above, below):
    steps = list(sw.march(scene(above, below), until=0.06, step=5e-3))
    assert len(steps) <= 14
    assert steps[-1].ledger.contacts["above-below"].force_t > 100.0
    energy = steps[0].ledger.energy_kinetic
    assert max(abs(step.ledger.energy_error) for step in steps) < 1e-9 * energy
    assert min(step.certificate.min_gap for step in steps) > -1e-12
