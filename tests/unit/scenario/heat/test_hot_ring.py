"""The hot ring between cold dies: exact heat of compression and of chill, and its shape and force by other slabs."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import erfcx

import softway as sw
from softway.record.run import Run

FILE = Path(__file__).parents[4] / "scenarios" / "hot_ring.toml"
HOT, COLD, CELLS = 1273.15, 473.15, (12, 10)
ISOTHERMAL = "bodies.ring.thermal.law.capacity=6e9 J/(kg*K)"
FINE = ("bodies.ring.mesh.cells=[24, 20]", "time.step=10 ms")


@cache
def ran(*changes: str) -> Run:
    return sw.run(sw.load(FILE, changes))


def bulge(run: Run) -> tuple[float, float]:
    """How much farther out the middle of the outer face, and farther in that of the hole, has moved than the end."""
    columns, rows = CELLS
    u = run.fields[-1].displacement[:, 0].reshape(rows + 1, columns + 1)
    return float(u[0, -1] - u[-1, -1]), float(u[-1, 0] - u[0, 0])


def squeezed(slabs: int) -> float:
    """Rise of the temperature without friction and without heat across the contact: compression is homogeneous."""
    no = ("contacts[0].heat.conductance=0", "contacts[0].friction.alpha=1e-12")
    plain = ("bodies.ring.mesh.cells=[2, 2]", "bodies.ring.material.bulk=6e14 Pa")  # no volume change
    run = sw.run(sw.load(FILE, (*no, *plain, f"time.step={0.4 / slabs} s")))
    temperature = run.fields[-1].more["temperature"]
    assert np.ptp(temperature) < 1e-6
    return float(temperature.mean()) - HOT


@pytest.mark.slow
def test_without_chill_and_friction_the_ring_warms_as_homogeneous_compression_says() -> None:
    """rho c dT/dt = K f(T) (sqrt(3) d)^(m+1) with the true rate d = v/(h - v t); of second order in the slab."""

    def rate(t: float, y: np.ndarray) -> list[float]:
        soft = np.exp(5000.0 * (1.0 / y[0] - 1.0 / HOT))
        return [60e6 * soft * (np.sqrt(3.0) / (1.0 - t)) ** 1.15 / (7800.0 * 600.0)]  # v/h = 1/s

    exact = solve_ivp(rate, (0.0, 0.4), [HOT], rtol=1e-10, atol=1e-8).y[0, -1] - HOT
    errors = np.abs(np.array([squeezed(n) for n in (10, 20, 40)]) - exact) / exact
    assert errors[-1] < 5e-5, errors
    ratios = errors[:-1] / errors[1:]
    assert (ratios > 3.8).all() and (ratios < 4.2).all(), errors


@pytest.mark.slow
def test_a_die_at_rest_chills_the_ring_as_a_half_space_with_surface_conductance() -> None:
    """Carslaw, Jaeger (1959), Conduction of heat in solids, 2.7: drop of the surface 1 - exp(z^2) erfc(z)."""
    still = ('bodies.die.motion.velocity=["0 mm/s", "0 mm/s"]', "bodies.ring.mesh.cells=[1, 60]")
    history = sw.run(sw.load(FILE, (*still, "time.end=0.2 s", "time.step=4 ms"))).history
    z = 2e4 * np.sqrt(history["time"] / (28.0 * 7800.0 * 600.0))
    exact = 1.0 - erfcx(z)
    found = (HOT - history["end"]) / (HOT - COLD)
    later = history["time"] > 0.02
    assert exact[-1] > 0.4 and abs(history["middle"][-1] - HOT) < 1e-3 * (HOT - COLD)
    np.testing.assert_allclose(found[later], exact[later], rtol=0.01)
    # heat through the surface: the integral of h (T - T die)
    heat = (HOT - COLD) * 28.0 * 7800.0 * 600.0 / 2e4 * (erfcx(z[-1]) - 1.0 + 2.0 * z[-1] / np.sqrt(np.pi))
    area = np.pi * (0.03**2 - 0.015**2)
    assert history["heat.through.die"][-1] == pytest.approx(heat * area, rel=0.01)


@pytest.mark.minutes
def test_chilled_ends_bulge_the_ring_and_need_more_force() -> None:
    chilled, even = ran(), ran(ISOTHERMAL)
    force, soft = (run.history["contact.die.force_n"][-1] for run in (chilled, even))
    assert np.ptp(even.history["end"]) < 1e-3 < 400.0 < HOT - chilled.history["end"][-1]
    assert force == pytest.approx(1.26 * soft, rel=0.02)
    (outer, inner), (outer_even, inner_even) = bulge(chilled), bulge(even)
    assert outer > 5.0 * outer_even > 0.0 and inner > 3e-3 and abs(inner_even) < 0.5e-3


@pytest.mark.slow
def test_the_ring_keeps_the_laws_of_heat() -> None:
    history = ran().history
    content, spent, received = history["heat.content"], history["dissipation"], history["heat.received"]
    # what heats: the flow and half of the friction; the other half, and what passes the contact, is in the die
    np.testing.assert_allclose(content - content[0], spent - history["heat.through.die"], atol=1e-12 * content[0])
    np.testing.assert_allclose(received, spent - history["heat.friction"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(content - content[0], received + history["heat.brought"], atol=1e-12 * content[0])
    assert abs(history["heat.error"]).max() < 1e-12 * content[0]
    assert np.diff(history["heat.entropy"]).min() > 0.0


@pytest.mark.minutes
def test_finer_cells_and_half_the_slab_change_little() -> None:
    """Force at the end 2.7 % greater than that of cells and slabs half as long, heat into the die 2.3 % greater."""
    for column in ("contact.die.force_n", "heat.through.die"):
        assert ran().history[column][-1] == pytest.approx(ran(*FINE).history[column][-1], rel=0.03)
    assert ran().history["end"][-1] == pytest.approx(ran(*FINE).history["end"][-1], abs=2.0)
