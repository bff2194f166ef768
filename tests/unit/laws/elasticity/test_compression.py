"""Stability of St. Venant-Kirchhoff matter under compression."""

import numpy as np
import pytest
from scipy.optimize import brentq

import softway as sw
from softway.laws.bulk import NeoHookean, StVenantKirchhoff
from softway.laws.elasticity.compression import BAR_STRETCH, plane_impact, stable_stretch


def least_speed(law: StVenantKirchhoff, stretch: float) -> float:
    """Least eigenvalue of the acoustic tensor over all directions of waves, at a stretch in one direction."""
    F = np.diag([stretch, 1.0, 1.0])
    E = 0.5 * (F @ F - np.eye(3))
    S, D = law.stress(E), law.tangent(E)
    found = []
    for angle in np.linspace(0.0, np.pi / 2, 181):
        n = np.array([np.cos(angle), np.sin(angle), 0.0])
        A = np.einsum("iI,kK,IJKL,J,L->ik", F, F, D, n, n) + (n @ S @ n) * np.eye(3)
        found.append(np.linalg.eigvalsh(A).min())
    return float(min(found))


@pytest.mark.parametrize("nu", [-0.99, -0.7, -0.3, 0.0, 0.2, 0.25, 0.3, 0.45, 0.499])
def test_waves_have_real_speeds_above_the_stable_stretch_only(nu: float) -> None:
    law = StVenantKirchhoff(E=2.0, nu=nu)
    stretch = stable_stretch(2.0 * nu / (1.0 - 2.0 * nu))
    assert least_speed(law, stretch) == pytest.approx(0.0, abs=1e-3)
    assert all(least_speed(law, s) > 0.0 for s in np.linspace(stretch + 1e-3, 1.0, 30))
    assert least_speed(law, stretch - 1e-2) < 0.0


CELLS = 80
END, STEP = 0.6, 0.005


def bar(material: StVenantKirchhoff | NeoHookean, speed: float) -> sw.Scene:
    """A bar of unit length and wave speed against a wall."""
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=CELLS),
        material=material,
        density=1.0,
        velocity=sw.bodies.Uniform(value=-speed),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=0.0, normal=1.0))
    return sw.Scene(bodies={"bar": body, "wall": wall}, contacts=(sw.Contact(between=("bar", "wall")),))


@pytest.mark.slow
@pytest.mark.few(1)
@pytest.mark.parametrize("speed", [0.1, 0.2])
def test_a_plane_impact_leaves_the_stretch_of_the_simple_wave(speed: float) -> None:
    steps = list(sw.march(bar(StVenantKirchhoff(E=1.0), speed), until=END, step=0.5 * STEP))
    stretch = 1.0 + CELLS * np.diff(steps[-1].after.displacement["bar"][:, 0])
    expected = brentq(lambda s: plane_impact(s) - speed, BAR_STRETCH, 1.0)
    assert np.mean(stretch[2:8]) == pytest.approx(expected, rel=5e-4)


@pytest.mark.slow
def test_a_faster_impact_collapses_st_venant_kirchhoff_and_not_neo_hookean_matter() -> None:
    with pytest.raises(sw.NumericsError, match="'bar' is crushed to") as failed:
        list(sw.march(bar(StVenantKirchhoff(E=1.0), 0.3), until=END, step=STEP))
    assert "NeoHookean" in failed.value.remedy
    assert len(list(sw.march(bar(NeoHookean(E=1.0), 0.3), until=END, step=STEP))) == round(END / STEP)
