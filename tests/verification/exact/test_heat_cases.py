"""G01 to G04: the references follow from the closed forms, and softway is within the tolerances."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import erf, erfc

import results
from softway.apps.verify.case import sheet
from softway.apps.verify.cases.heat import g01_freezing_water as water
from softway.apps.verify.cases.heat import g02_adiabatic_compression as press
from softway.apps.verify.cases.heat import g03_braking_block as brake
from softway.apps.verify.cases.heat import g04_closing_gap as gap


def value(case: str, name: str) -> float:
    return next(q["value"] for q in sheet(case)["qoi"] if q["name"] == name)


def test_the_root_keeps_the_balance_of_heat_at_the_front() -> None:
    given, root = water.GIVEN, water.ROOT
    ratio = sqrt(water.ICE / water.WATER)
    solid = np.exp(-(root**2)) / erf(root)
    liquid = given["kl"] / given["ks"] * ratio * given["Ti"] / -given["Tw"] * np.exp(-((root * ratio) ** 2))
    latent = root * given["L"] * sqrt(pi) / (given["cs"] * -given["Tw"])
    assert solid - liquid / erfc(root * ratio) == pytest.approx(latent, rel=1e-12)
    assert water.front(3600.0) == pytest.approx(value("G01", "front at 1 h"), rel=1e-12)
    assert water.front(36000.0) == pytest.approx(sheet("G01")["reference"]["front_10h"], rel=1e-12)
    found = water.temperature(np.array([0.01, 0.05]), 3600.0)
    assert found == pytest.approx([value("G01", "T(1 cm, 1 h)"), value("G01", "T(5 cm, 1 h)")], rel=1e-12)


def test_the_work_of_compression_heats() -> None:
    given, heats = press.GIVEN, press.GIVEN["rho"] * press.GIVEN["c"]
    metal, fluid = given["plastic"], given["viscous"]
    stress = sqrt(3.0) ** (fluid["m"] + 1.0) * fluid["K"] * fluid["rate"] ** fluid["m"]
    plastic = metal["share"] * metal["yield_stress"] * given["strain"] / heats
    assert plastic == pytest.approx(value("G02", "rise, plastic"), rel=1e-12)
    assert fluid["share"] * stress * given["strain"] / heats == pytest.approx(value("G02", "rise, viscous"), rel=1e-12)


def test_the_surface_under_the_brake_is_the_integral_of_duhamel() -> None:
    given = brake.GIVEN
    effusivity = sqrt(given["k"] * given["rho"] * given["c"])
    for time in (1.0, 2.0):  # with s^2 for the time since the heat came
        heat = quad(lambda s, end=time: 2.0 * given["q0"] * (1.0 - (end - s * s) / given["ts"]), 0.0, sqrt(time))[0]
        assert brake.rise(np.array(time)) == pytest.approx(heat / (effusivity * sqrt(pi)), rel=1e-12)
    assert brake.rise(np.array(1.0)) == pytest.approx(value("G03", "greatest rise of the surface"), rel=1e-12)
    assert brake.rise(np.array(2.0)) == pytest.approx(value("G03", "rise of the surface at 2 s"), rel=1e-12)


def test_the_bar_has_closed_the_gap_when_its_mean_temperature_says_so() -> None:
    given, time = gap.GIVEN, np.array(value("G04", "contact, slabs of 5 s"))
    assert given["expansion"] * given["length"] * gap.mean_rise(time) == pytest.approx(given["gap"], rel=1e-12)
    stress = given["gap"] / given["length"] - given["expansion"] * given["rise"]
    assert value("G04", "stress over E at the end") == pytest.approx(stress, rel=1e-12)


@pytest.mark.parametrize("case", [pytest.param("G01", marks=pytest.mark.slow), "G02", "G03", "G04"])
def test_the_case(case: str) -> None:
    assert results.missed(case) == set()
