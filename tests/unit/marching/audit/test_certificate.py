"""What a slab may leave over, and what is too much: the limits of the table in docs/theory/time/control.md."""

from dataclasses import replace

import numpy as np
import pytest

from softway.contact.impact_rule import Impulse, Paper
from softway.marching.attempts import audited_slab
from softway.marching.audit.certificate import violation


def judged_slabs(shop, **options: object) -> list[tuple]:
    """What the certificates of a block that falls on a floor were judged by, where it is pushed."""
    judged = []

    def listening(*everything):
        judged.append(everything)
        return violation(*everything)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(audited_slab, "violation", listening)
        shop.move(shop.block((0.03, -0.1)), shop.floor, until=1.0, **options)
    pushed = [slab for slab in judged if slab[3].pressure.max() > 0.0]
    assert len(pushed) > 5
    return pushed


@pytest.fixture(scope="module")
def slabs(shop) -> list[tuple]:
    return judged_slabs(shop)


def changed(slab: tuple, **numbers: float) -> str:
    """What is wrong with a slab that leaves over other numbers; nothing if nothing is."""
    return violation(*slab[:-1], replace(slab[-1], **numbers)) or ""


def test_residuals_of_a_march_satisfy_the_certificate(slabs) -> None:
    assert not any(changed(slab) for slab in slabs)


def test_a_depth_is_too_much_beyond_1e_12_of_the_greatest_coordinate(slabs) -> None:
    """The block is one metre high, and at most a tenth of that above the floor or within itself."""
    for slab in slabs:
        assert not changed(slab, min_gap=-0.5e-12)
        assert "inside its opponent" in changed(slab, min_gap=-2e-12)


def test_a_pull_is_too_much_beyond_1e_12_of_the_greatest_force(slabs) -> None:
    for slab in slabs:
        most = slab[3].pressure.max()
        assert not changed(slab, min_force=-0.5e-12 * most)
        assert "a contact row is in tension" in changed(slab, min_force=-2e-12 * most)


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["gain", "loss"])
def test_an_energy_is_too_much_beyond_1e_9_of_those_that_take_part(slabs, sign: float) -> None:
    """These are at least the energy of the block once, and at most that at both ends of the slab."""
    for slab in slabs:
        energy = slab[4].energy_kinetic + slab[4].energy_strain
        assert not changed(slab, energy_error=sign * 0.9e-9 * energy)
        assert "the energy balance" in changed(slab, energy_error=sign * 3e-9 * energy)


def test_a_momentum_is_too_much_beyond_1e_9_of_those_that_take_part(slabs) -> None:
    """At least that of the block, of 1 kg, and no more than a few times that of its fall at 0.1 m/s."""
    for slab in slabs:
        own = np.linalg.norm(slab[4].momentum)
        assert not changed(slab, momentum_error=1e-9 * own)
        assert "the momentum balance" in changed(slab, momentum_error=2e-9)


def test_of_nodes_with_inertia_the_momentum_is_judged_unless_the_rule_resets_velocities(shop) -> None:
    """And the energy, whose error is of the order of the slab, in one slab and in all, where no velocity is reset."""
    for slab in judged_slabs(shop, timing=Impulse()):
        assert "the momentum balance" in changed(slab, momentum_error=2e-9) and not changed(slab, energy_error=-1.0)
        level = slab[4].energy_kinetic + slab[4].energy_strain
        assert not changed(slab, energy_error=2.9e-3 * level)
        assert "too long for its touches" in changed(slab, energy_error=1e-2 * level)
        for growth, message in ((-1.0, None), (0.09, None), (0.4, "too long for the touches")):
            found = violation(*slab[:4], replace(slab[4], energy_error=growth * level), slab[5])
            assert found is None if message is None else message in found
    for slab in judged_slabs(shop, timing=Paper()):
        assert not changed(slab, momentum_error=1.0, energy_error=1.0)


@pytest.mark.parametrize("name", ["min_gap", "min_force", "power_residual", "momentum_error", "energy_error"])
def test_nan_violates_the_certificate(slabs, name: str) -> None:
    assert "not a number" in changed(slabs[0], **{name: float("nan")})
    if name != "min_gap":  # nothing in reach
        assert "not a number" in changed(slabs[0], **{name: float("inf")})
