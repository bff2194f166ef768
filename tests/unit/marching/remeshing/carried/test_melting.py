"""Solids that melt on meshes that change: contents, entropies, Neumann's solution, and the finest mesh."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from adapting import adaptive_march
from passing import finest
from scipy.optimize import brentq
from scipy.special import erf, erfc

import softway as sw
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.generators.shapes import interval, rectangle
from softway.meshes.mesh import Mesh

MELTING, WALL, START = 273.15, 283.15, 271.15
HEAT, CAPACITY, DIFFUSIVITY, LENGTH = 334e3, 2000.0, 1e-6, 0.1
SHARP = sw.heat.Latent(melting=MELTING, heat=HEAT)
ADAPT = Adapt(levels=4, smooth=0.0, buffer=3)


def frozen(mesh: Mesh, latent: sw.heat.Latent = SHARP) -> sw.Scene:
    """Cold matter at a wall that is warmer than its melting."""
    law = sw.heat.Conduction(conductivity=1e3 * DIFFUSIVITY * CAPACITY, capacity=CAPACITY, latent=latent)
    thermal = sw.bodies.Thermal(law=law, temperature=START)
    body = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1e9), density=1e3, thermal=thermal)
    return sw.Scene(bodies={"body": body}, loads=(sw.heat.Temperature(on="body.left", value=WALL),))


def stefan() -> float:
    """Place of the front over ``2 sqrt(a t)``."""

    def gap(x: float) -> float:
        flux = (WALL - MELTING) / erf(x) - (MELTING - START) / erfc(x)
        return float(flux * np.exp(-x * x) - np.sqrt(np.pi) * x * HEAT / CAPACITY)

    return float(brentq(gap, 1e-3, 2.0))


def neumann(x: Array, time: float) -> Array:
    """Temperatures of Neumann's solution."""
    z, front = x / (2.0 * np.sqrt(DIFFUSIVITY * time)), stefan()
    melted = WALL - (WALL - MELTING) * erf(z) / erf(front)
    return np.where(z < front, melted, START + (MELTING - START) * erfc(z) / erfc(front))


def errors(steps: Sequence[sw.Step]) -> tuple[float, float, int]:
    """Root mean square error of the temperature [K], the greatest one of the front, relative, and the dof-steps."""
    squares, fronts, x = [], [], np.linspace(0.0, LENGTH, 1001)
    for step in (s for s in steps if s.after.time > 100.0):
        points, found = step.model.points[:, 0], step.after.fields["temperature"]["body"][:, 0]
        order, heat = np.argsort(points), step.ledger.heat
        assert heat is not None
        there = np.interp(x, points[order], found[order])
        squares.append(np.mean((there - neumann(x, step.after.time)) ** 2))
        place = 2.0 * stefan() * np.sqrt(DIFFUSIVITY * step.after.time)
        fronts.append(abs(heat.liquid["body"] / place - 1.0))
    return float(np.sqrt(np.mean(squares))), max(fronts), sum(len(s.model.points) for s in steps)


def keeps_its_heat(steps: Sequence[sw.Step]) -> int:
    """Contents are in the account to rounding, and changes of meshes lower no entropy; number of the changes."""
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        old, new = last.ledger.heat, taken.ledger.heat
        assert old is not None
        assert new is not None
        assert abs(new.error) < 1e-12 * abs(new.brought)
        assert new.entropy - new.produced >= old.entropy - 1e-12 * new.passed
    return sum(bool(step.transfers) for step in steps)


@pytest.mark.slow
def test_front_of_neumanns_solution() -> None:
    base = interval(LENGTH, cells=8)
    steps = list(adaptive_march(frozen(base), {"body": ADAPT}, until=600.0, step=10.0))
    assert keeps_its_heat(steps) > 2
    found = errors(steps)
    fine = errors(list(sw.march(frozen(interval(LENGTH, cells=128)), until=600.0, step=10.0)))
    coarse = errors(list(sw.march(frozen(interval(LENGTH, cells=32)), until=600.0, step=10.0)))
    assert found[0] < 1.03 * fine[0]
    assert found[1] < 1.03 * fine[1]
    assert found[0] < 0.6 * coarse[0]
    assert 3.0 * found[2] < fine[2]


MELTS = {
    "mushy bar": (interval(LENGTH, cells=8), replace(SHARP, half_range=0.5), 3),
    "tri3": (rectangle((LENGTH, LENGTH / 4), (8, 2), cell="tri3"), SHARP, 4),
    "quad4": (rectangle((LENGTH, LENGTH / 4), (8, 2), cell="quad4"), SHARP, 4),
    "mushy quad4": (rectangle((LENGTH, LENGTH / 4), (8, 2), cell="quad4"), replace(SHARP, half_range=0.5), 4),
    "quad9": (rectangle((LENGTH, LENGTH / 4), (8, 2), cell="quad9"), SHARP, 2),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", MELTS.values(), ids=MELTS)
def test_contents_and_entropies(case: tuple[Mesh, sw.heat.Latent, int]) -> None:
    mesh, latent, levels = case
    scene = frozen(mesh, latent)
    adapt = replace(ADAPT, levels=levels, buffer=1, contact_cells=2)
    steps = list(adaptive_march(scene, {"body": adapt}, until=600.0, step=20.0))
    assert keeps_its_heat(steps) > 0
    *_, fine = sw.march(finest(scene, levels, "body"), until=600.0, step=20.0)
    one, other = steps[-1].ledger.heat, fine.ledger.heat
    assert one is not None
    assert other is not None
    assert one.liquid["body"] == pytest.approx(other.liquid["body"], rel=0.02)
    assert one.brought == pytest.approx(other.brought, rel=0.02)
