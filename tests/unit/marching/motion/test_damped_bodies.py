"""Damped bodies in motion: what the mean rate of a slab makes acts from its start."""

import numpy as np
import pytest

import softway as sw


def block(viscosity: float, velocity: sw.bodies.Affine | sw.bodies.Uniform) -> sw.Solid:
    return sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.2, 0.04), cells=(2, 2)),
        material=sw.laws.Kelvin(E=1e7, shear_viscosity=viscosity, bulk_viscosity=viscosity),
        density=130.0,
        velocity=velocity,
    )


@pytest.mark.parametrize("method", [sw.FixedPoint(), sw.Newton()], ids=["fixed point", "newton"])
@pytest.mark.parametrize(("viscosity", "most"), [(1e3, 8.4), (1e4, 9.9), (1e5, 13.8)])
def test_strong_damping_costs_few_iterations(viscosity, most, method):
    """The operator knows that damping acts twice as much as a stiffness: waves of the block are over-damped.

    An operator without this takes 9.2, 11.2 and 16.6 iterations a slab at least, this one 7.6, 8.6 and 11 at most.

    The energy balance is left with what the iteration leaves of the velocity: viscous forces multiply it.
    """
    scene = sw.Scene(
        bodies={"b": block(viscosity, sw.bodies.Affine(gradient=((0.5, 0.2), (0.1, -0.3)), value=(0.0, 0.0)))}
    )
    steps = list(sw.march(scene, until=0.025, step=5e-3, method=method))
    assert np.mean([s.report.iterations for s in steps]) <= most
    assert not any(s.report.rejections for s in steps)
    assert max(abs(s.ledger.energy_error) for s in steps) < method.tolerance * steps[0].ledger.energy_kinetic


@pytest.mark.slow
def test_a_damped_block_slides_to_rest():
    """The slab after the halt, whose peak is at its end, keeps the momentum balance with viscous stresses too."""
    scene = sw.Scene(
        bodies={
            "b": block(2e2, sw.bodies.Uniform(value=(0.5, 0.0))),
            "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0))),
        },
        contacts=(sw.Contact(between=("b.bottom", "floor"), friction=sw.Coulomb(mu=0.3)),),
        loads=(sw.Gravity(acceleration=(0.0, -9.81)),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=(0.3 * 9.81, -9.81)),)),
    )
    steps = list(sw.march(scene, until=0.25, step=2e-3))
    way = steps[-1].after.displacement["b"][:, 0].mean()
    assert way == pytest.approx(0.5**2 / (2.0 * 0.3 * 9.81), rel=1e-3)
    ends = [s.after.displacement["b"][0, 0] for s in steps if s.after.time > 0.2]
    assert np.ptp(ends) < 1e-9
    assert any(s.slab.weight == sw.model.EndPeaks(theta=1.0) for s in steps)
    assert not any(s.report.rejections for s in steps)


def drooping_strip(step: float) -> list[sw.Step]:
    """A clamped strip of one cell through its thickness sags; its lower face may touch a floor far below."""
    strip = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.15, 0.004), cells=(40, 1)),
        material=sw.laws.Kelvin(E=2e6, nu=0.4, shear_viscosity=2e3),
        density=1000.0,
        supports=(sw.Fixed(on="left"),),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.5), normal=(0.0, 1.0)))
    scene = sw.Scene(
        bodies={"strip": strip, "floor": floor},
        contacts=(sw.Contact(between=("strip.bottom", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, -9.81)),),
    )
    return list(sw.march(scene, until=0.03, step=step))


@pytest.mark.slow
def test_a_damped_strip_with_nodes_without_inertia_sags_without_rejections():
    """The balance by the forces of massless nodes: the boxed form took 32 iterations a slab and 24 rejections.

    The dissipation is that of short slabs, 4.2696e-4 J, of the order 1.6 in the step.  The balance is left with the
    tolerance of the iteration times the stiffness along the strip, 1e4 times that of bending.
    """
    coarse, fine = drooping_strip(1e-3), drooping_strip(2.5e-4)
    assert not any(s.report.rejections for s in (*coarse, *fine))
    assert np.mean([s.report.iterations for s in coarse]) < 20.0
    assert np.mean([s.report.iterations for s in fine]) < 14.0
    for steps, error in ((coarse, 2e-3), (fine, 2e-4)):
        assert steps[-1].ledger.dissipation == pytest.approx(4.2696e-4, rel=error)
        assert max(abs(s.ledger.energy_error) for s in steps) < 1e-8 * steps[-1].ledger.energy_kinetic


def tilted_box(step: float, cells: tuple[int, int]) -> list[sw.Step]:
    box = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.036, 0.024), cells=cells),
        material=sw.laws.Kelvin(E=1e6, nu=0.4, shear_viscosity=100.0),
        density=1000.0,
        place=sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=np.pi / 6.0),), bottom=1e-4),
        velocity=sw.bodies.Uniform(value=(0.0, -1.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("box", "floor"), friction=sw.Coulomb(mu=0.3))
    scene = sw.Scene(bodies={"box": box, "floor": floor}, contacts=(contact,))
    return list(sw.march(scene, until=0.02, step=step))


@pytest.mark.slow
def test_a_damped_box_that_bounces_is_not_held_up():
    """After the release the forces at the ends of a slab are nearly the same: the viscous ones close the balance.

    The scalar alone is not determined there: the slabs shrink to 1 ns and the run stops.  Spin with twice as many cells
    along each side: -6.39e-3 in slabs of 1/8 ms.
    """
    coarse, fine, twice = tilted_box(1e-3, (4, 3)), tilted_box(1.25e-4, (4, 3)), tilted_box(1e-3, (8, 6))
    assert not any(s.report.rejections for s in (*fine, *twice))
    for steps in (coarse, fine, twice):
        assert steps[-1].after.time == pytest.approx(0.02, abs=1e-15)
        assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * steps[0].ledger.energy_kinetic
    assert twice[-1].ledger.spin[2] == pytest.approx(-6.39e-3, rel=0.1)
