"""Virtual time functions: moments, amplification and stability, against the scheme solved directly and closed forms."""

from math import inf, sqrt

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from softway.errors import InputError
from softway.model.time_weight import Collocation, EndPeaks, Momentum, TimeWeight, amplification, limit, moments, peaks

CONSTANT = [Momentum(points=p) for p in (2, 3, 5)]
NAMED = [*CONSTANT, Collocation(), Collocation(at=(0.75,)), EndPeaks(), EndPeaks(theta=0.7), EndPeaks(theta=1.0)]
phase = st.floats(0.05, 6.0)


@st.composite
def weights(draw: st.DrawFn) -> Collocation:
    """One to four peaks of positive weight."""
    at = draw(st.lists(st.floats(0.0, 1.0).map(lambda t: round(t, 3)), min_size=1, max_size=4, unique=True))
    raw = np.array(draw(st.lists(st.floats(0.1, 1.0), min_size=len(at), max_size=len(at))))
    return Collocation(at=tuple(at), weights=tuple((raw / raw.sum()).tolist()))


def radius(weight: TimeWeight, z: float) -> float:
    return float(np.abs(np.linalg.eigvals(amplification(weight, z))).max())


@pytest.mark.parametrize("weight", NAMED, ids=str)
def test_a_weight_sums_to_one_inside_the_slab(weight: TimeWeight) -> None:
    tau, w = peaks(weight)
    assert w.sum() == pytest.approx(1.0, abs=1e-14)
    assert ((tau >= 0.0) & (tau <= 1.0)).all()


@pytest.mark.parametrize("weight", CONSTANT, ids=str)
def test_the_constant_weight_has_the_moments_of_a_constant(weight: Momentum) -> None:
    assert moments(weight) == pytest.approx((1 / 2, 1 / 3), abs=1e-15)
    tau, w = peaks(weight)
    highest = 2 * weight.points - 1
    assert w @ tau**highest == pytest.approx(1 / (highest + 1), abs=1e-15)


@given(theta=st.floats(0.5, 1.0))
def test_moments_of_end_peaks(theta: float) -> None:
    assert moments(EndPeaks(theta=theta)) == (theta, theta)


@given(weight=weights(), z=phase)
def test_trace_and_determinant_follow_from_the_moments(weight: Collocation, z: float) -> None:
    mu1, mu2 = moments(weight)
    d = 1.0 + 0.5 * z**2 * mu2
    a = amplification(weight, z)
    assert np.trace(a) == pytest.approx(2.0 - z**2 * (0.5 + mu1) / d, abs=1e-12)
    assert np.linalg.det(a) == pytest.approx(1.0 + z**2 * (0.5 - mu1) / d, abs=1e-12)


@given(weight=weights(), z=phase, x0=st.floats(-1.0, 1.0), hv0=st.floats(-1.0, 1.0))
def test_amplification_is_the_slab_of_an_oscillator(weight: Collocation, z: float, x0: float, hv0: float) -> None:
    x1, hv1 = amplification(weight, z) @ [x0, hv0]
    tau, w = peaks(weight)
    path = x0 + hv0 * tau + (hv1 - hv0) * tau**2 / 2
    assert hv1 - hv0 + z**2 * (w @ path) == pytest.approx(0.0, abs=1e-12 * (1.0 + z**2))
    assert x1 == pytest.approx(x0 + (hv0 + hv1) / 2, abs=1e-12 * (1.0 + z**2))


@given(z=phase)
def test_closed_forms_of_the_trace(z: float) -> None:
    o = z**2
    forms = {
        Momentum(): -4 * (o - 3) / (o + 6),
        Collocation(): -2 * (3 * o - 8) / (o + 8),
        EndPeaks(): 2 * (4 - o) / (4 + o),
        EndPeaks(theta=0.8): (4 - o) / (0.8 * o + 2),
    }
    for weight, trace in forms.items():
        assert np.trace(amplification(weight, z)) == pytest.approx(trace, abs=1e-12)


@given(z=st.floats(0.05, 50.0))
def test_end_peaks_of_one_half_keep_the_energy(z: float) -> None:
    a = amplification(EndPeaks(), z)
    energy = np.diag([z**2, 1.0])
    np.testing.assert_allclose(a.T @ energy @ a, energy, atol=1e-11 * (1.0 + z**2))


@given(theta=st.floats(0.5, 1.0), z=st.floats(0.01, 1e3))
def test_end_peaks_never_grow(theta: float, z: float) -> None:
    assert limit(EndPeaks(theta=theta)) == inf
    assert radius(EndPeaks(theta=theta), z) <= 1.0 + 1e-7


@given(weight=weights())
def test_the_limit_separates_stable_from_unstable(weight: Collocation) -> None:
    mu1, mu2 = moments(weight)
    assume(mu1 > 0.501 and mu1 - mu2 > 1e-3)
    bound = limit(weight)
    assert radius(weight, 0.999 * bound) <= 1.0 + 1e-9
    assert radius(weight, 1.01 * bound) > 1.0


@given(weight=weights())
def test_only_peaks_at_the_ends_are_stable_for_every_step(weight: Collocation) -> None:
    assume(moments(weight)[0] >= 0.5)
    inside = any(1e-9 < t < 1.0 - 1e-9 for t in weight.at)
    assert (limit(weight) < inf) == inside


def test_limits_in_closed_form() -> None:
    assert limit(Momentum()) == pytest.approx(2 * sqrt(3), rel=1e-14)
    assert limit(Collocation()) == pytest.approx(2 * sqrt(2), rel=1e-14)
    assert limit(Collocation(at=(2 / 3,))) == pytest.approx(3.0, rel=1e-14)
    assert limit(Collocation(at=(0.4,))) == 0.0


@pytest.mark.parametrize(
    ("weight", "leading"),
    [(Momentum(), -1 / 24), (Collocation(), -1 / 48), (EndPeaks(), -1 / 12)],
    ids=["constant", "middle", "ends"],
)
def test_leading_error_of_the_frequency(weight: TimeWeight, leading: float) -> None:
    """Krieg, Key (1973), Int. J. Numer. Meth. Engng 7, 273: linear acceleration, average acceleration."""
    z = 0.02
    angle = np.arccos(np.trace(amplification(weight, z)) / 2)
    assert (angle / z - 1.0) / z**2 == pytest.approx(leading, rel=2e-3)


@pytest.mark.parametrize(
    ("wrong", "where"),
    [
        (lambda: Momentum(points=1), "points"),
        (lambda: Collocation(at=(0.1, 0.9), weights=(1.0,)), "weights"),
        (lambda: Collocation(at=(), weights=()), "weights"),
        (lambda: Collocation(at=(1.5,), weights=(1.0,)), "at"),
        (lambda: Collocation(at=(0.5,), weights=(0.9,)), "weights"),
        (lambda: EndPeaks(theta=0.4), "theta"),
        (lambda: EndPeaks(theta=float("nan")), "theta"),
    ],
)
def test_wrong_weights_are_refused(wrong: object, where: str) -> None:
    with pytest.raises(InputError) as error:
        wrong()
    assert error.value.where == where
    assert error.value.remedy
