"""A01: what a slab does to an oscillator, in closed form and in a march of one element."""

import numpy as np
import pytest
from scipy.linalg import eigh

import results
import softway as sw
from softway.apps.verify.exact import oscillator as exact
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars
from softway.model.time_weight import TimeWeight, amplification, limit, moments

PEAK = sw.model.Collocation(at=(0.75,), weights=(1.0,))
WEIGHTS = [
    sw.model.Momentum(),
    bars.MIDDLE,
    PEAK,
    bars.FOURTH,
    sw.model.EndPeaks(),
    sw.model.EndPeaks(theta=0.7),
    sw.model.EndPeaks(theta=1.0),
]
FREQUENCY = {sw.bodies.Consistent(): np.sqrt(3.0), sw.bodies.Lumped(): np.sqrt(2.0)}
masses = pytest.mark.parametrize("mass", FREQUENCY, ids=lambda m: type(m).__name__)
weights = pytest.mark.parametrize("weight", WEIGHTS, ids=str)


def oscillator(mass: sw.bodies.Consistent | sw.bodies.Lumped, displacement: float, velocity: float) -> sw.Solid:
    """One element of unit stiffness, one end fixed."""
    return sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1),
        material=bars.ELASTIC,
        density=1.0,
        displacement=sw.bodies.OnTag(tag="right", value=displacement),
        velocity=sw.bodies.OnTag(tag="right", value=velocity),
        supports=(sw.Fixed(on="left"),),
        mass=mass,
    )


def marched(
    mass: sw.bodies.Consistent | sw.bodies.Lumped,
    weight: TimeWeight,
    step: float,
    start: tuple[float, float],
    slabs: int = 1,
) -> np.ndarray:
    """End values of (x, h v) after some slabs, with a stop out of reach."""
    bar = oscillator(mass, start[0], start[1] / step)
    stop = sw.obstacles.HalfSpace(point=1.0 + bars.OUT_OF_REACH, normal=-1.0)
    march = bars.run(bar, stop, sw.contact.Impulse(), until=slabs * step, step=step, weight=weight)
    return np.array([march.displacement[-1, 1], step * march.velocity[-1, 1]])


def test_case() -> None:
    assert results.missed("A01") == set()


@weights
def test_the_matrix_is_the_closed_form(weight: TimeWeight) -> None:
    for z in (0.1, 0.5, 1.0, 2.0):
        radius = np.abs(np.linalg.eigvals(amplification(weight, z))).max()
        assert radius == pytest.approx(exact.radius(moments(weight), z), abs=1e-12)
    assert limit(weight) == pytest.approx(exact.limit(moments(weight)), rel=1e-12)


@masses
@weights
def test_a_slab_of_the_march_is_the_matrix(mass: sw.bodies.Consistent | sw.bodies.Lumped, weight: TimeWeight) -> None:
    for z in (0.1, 0.5, 1.0, 2.0):
        step = z / FREQUENCY[mass]
        columns = [marched(mass, weight, step, start) for start in ((1.0, 0.0), (0.0, 1.0))]
        np.testing.assert_allclose(np.array(columns).T, amplification(weight, z), rtol=0.0, atol=1e-13)


@weights
def test_the_weight_acts_the_same_in_a_scene_without_contact(weight: TimeWeight) -> None:
    for start in ((1.0, 0.0), (0.0, 1.0)):
        bar = oscillator(sw.bodies.Consistent(), start[0], start[1] * np.sqrt(3.0))
        march = bars.run(
            bar, None, sw.contact.Energy(), until=1.0 / np.sqrt(3.0), step=1.0 / np.sqrt(3.0), weight=weight
        )
        found = march.displacement[-1, 1], march.velocity[-1, 1] / np.sqrt(3.0)
        np.testing.assert_allclose(found, amplification(weight, 1.0) @ start, rtol=0.0, atol=1e-13)


def test_a_long_march_keeps_or_loses_amplitude_as_the_radius_says() -> None:
    """The peak at 3/4 has det < 1; the constant keeps the quadratic form of its matrix, here (x, x-dot/omega)."""
    for weight, z, slabs in ((PEAK, 0.5, 60), (sw.model.Momentum(), 3.4, 60), (sw.model.EndPeaks(), 50.0, 60)):
        step = z / FREQUENCY[sw.bodies.Consistent()]
        end = marched(sw.bodies.Consistent(), weight, step, (1.0, 0.0), slabs)
        power = np.linalg.matrix_power(amplification(weight, z), slabs) @ (1.0, 0.0)
        np.testing.assert_allclose(end, power, rtol=0.0, atol=1e-11 * max(1.0, np.abs(power).max()))


@masses
def test_a_step_beyond_the_limit_is_refused_with_the_limit(mass: sw.bodies.Consistent | sw.bodies.Lumped) -> None:
    greatest = 2.0 * np.sqrt(3.0) / FREQUENCY[mass]
    marched(mass, sw.model.Momentum(), 0.9999 * greatest, (1.0, 0.0))
    with pytest.raises(sw.InputError, match=f"{greatest:.6g} s of Momentum") as caught:
        marched(mass, sw.model.Momentum(), 1.0001 * greatest, (1.0, 0.0))
    assert caught.value.where == "time.step"
    with pytest.raises(sw.InputError, match="stability limit"):
        marched(mass, bars.MIDDLE, 1.0001 * 2.0 * np.sqrt(2.0) / FREQUENCY[mass], (1.0, 0.0))


def test_the_end_peaks_are_stable_for_every_step() -> None:
    for z in (10.0, 1e3, 1e6):
        end = marched(sw.bodies.Consistent(), sw.model.EndPeaks(), z / np.sqrt(3.0), (1.0, 0.0), slabs=7)
        assert abs(end[0]) <= 1.0 + 1e-9


def test_the_limit_of_a_bar_is_that_of_its_highest_mode() -> None:
    """For the constant weight and a consistent mass it tends to edge / c: omega tends to 2 sqrt(3) c / edge."""
    for cells in (2, 10, 40):
        mesh = discrete.bar(cells, fixed=True)
        greatest = np.sqrt(12.0 / eigh(mesh.stiffness, mesh.mass, eigvals_only=True)[-1])
        with pytest.raises(sw.InputError, match=f"limit {greatest:.6g} s"):
            bars.struck(cells, sw.contact.Impulse(), step=1.1 * greatest, weight=sw.model.Momentum())
    assert greatest * cells == pytest.approx(1.0, abs=1e-3)
