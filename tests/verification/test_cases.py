"""The cases hold what the exact solutions give, and the checker tells right from wrong."""

import json
from pathlib import Path

import numpy as np
import pytest

import check_case
from softway.apps import verify
from softway.apps.verify.cases.contact import (
    b02_plane_wave,
    b03_cylinder_on_plane,
    b04_hemisphere_on_plane,
    b05_ball_impact,
    b06_press_fit,
)
from softway.apps.verify.cases.waves import a08_unequal_bars
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.exact import flow, shear
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.exact.oscillator import CONSTANT, frequency, limit, peak, radius
from softway.apps.verify.exact.thrown import Thrown

FOLDER = Path(verify.__file__).parent / "data"
CASES = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.rglob("*.json"))}
HAT = ((0.0, 0.5, 1.0, 0.0), (0.5, 1.0, 0.0, 0.0))


def value(case: str, name: str) -> np.ndarray:
    """Value of a quantity of interest."""
    return np.array(next(q["value"] for q in CASES[case]["qoi"] if q["name"] == name))


@pytest.mark.parametrize("name", CASES)
def test_a_case_is_complete(name: str) -> None:
    case = CASES[name]
    assert case.keys() == {"id", "title", "definition", "reference", "qoi"}
    assert case["id"] == name
    names = [q["name"] for q in case["qoi"]]
    assert len(set(names)) == len(names)
    for quantity in case["qoi"]:
        assert quantity.keys() <= {"name", "value", "tol_abs", "tol_rel", "mesh", "why"}
        assert np.all(np.isfinite(np.asarray(quantity["value"], float)))
        assert quantity.get("tol_abs", 0.0) > 0.0 or quantity.get("tol_rel", 0.0) > 0.0


def test_all_cases_are_there() -> None:
    """Every file is a case of the catalogue."""
    assert {case.id for case in verify.listed()} == set(CASES)


def test_a01_is_the_closed_form() -> None:
    weights = [CONSTANT, peak(0.5), peak(0.75), peak(1.0)]
    pairs = [(m, z) for m in weights for z in CASES["A01"]["definition"]["z"]]
    np.testing.assert_allclose(value("A01", "spectral radius each z"), [radius(*p) for p in pairs], atol=1e-13)
    swinging = [p for p in pairs if p != (peak(0.5), 3.0)]
    np.testing.assert_allclose(value("A01", "Omega/omega"), [frequency(*p) for p in swinging], rtol=1e-12)
    assert value("A01", "stability limit of const weighting") == pytest.approx(limit(CONSTANT), rel=1e-14)


def test_a03_is_the_motion_of_two_elements() -> None:
    rows = CASES["A03"]["reference"]["refinement"]["rows"]
    for mass, elements, release, energy, velocity in rows:
        mesh = discrete.bar(elements, lumped=mass == "lumped")
        motion = discrete.solve(mesh, np.zeros(elements + 1), np.ones(elements + 1), gap=0.0, until=6.0)
        found = (motion.times("release")[0], motion.energy(6.0), motion.mean_velocity(6.0))
        assert found == pytest.approx((release, energy, velocity), abs=1e-11)
    motion = discrete.solve(discrete.bar(2), np.zeros(3), np.ones(3), gap=0.0, until=7.0)
    table = [motion.at(t)[0] for t in CASES["A03"]["definition"]["times"]]
    np.testing.assert_allclose(value("A03", "u(t) table csv"), table, atol=1e-12)
    assert value("A03", "release time, ne=2 consistent") == pytest.approx(rows[0][2], abs=1e-12)


def test_a04_is_the_motion_of_two_oscillators() -> None:
    for lumped, middle in ((False, True), (True, False)):
        mesh = discrete.bar(2, lumped=lumped, fixed=True)
        u, _, _ = discrete.solve(mesh, np.zeros(2), np.array([0.0, 1.0]), gap=np.inf, until=10.0).at(10.0)
        mass = "lumped" if lumped else "consistent"
        assert value("A04", f"u_tip(10) {mass}") == pytest.approx(u[1], abs=1e-13)
        if middle:
            assert value("A04", f"u_mid(10) {mass}") == pytest.approx(u[0], abs=1e-13)


@pytest.mark.parametrize(
    "case", CASES["A05"]["reference"]["cases"], ids=lambda c: f"{c['mass']}-{c['rule']}-{c['side']}-{c['gap']}"
)
def test_a05_is_the_motion_with_the_stop(case: dict) -> None:
    mesh = discrete.bar(2, lumped=case["mass"] == "lumped", fixed=True)
    start = np.array([0.0, 1.0])
    motion = discrete.solve(mesh, np.zeros(2), start, gap=case["gap"], until=10.0, rule=case["rule"], side=case["side"])
    assert [e.kind for e in motion.events] == [kind for kind, _ in case["events"]]
    np.testing.assert_allclose([e.time for e in motion.events], [t for _, t in case["events"]], atol=1e-12)
    np.testing.assert_allclose(motion.at(10.0)[0], case["displacement_end"], atol=1e-12)
    assert motion.energy(10.0) == pytest.approx(case["energy_end"], abs=1e-13)


@pytest.mark.parametrize(
    ("name", "column", "bar"),
    [
        ("A06", "tip_with_stop", waves.Bar(velocity=HAT, gap=0.2, far="fixed")),
        ("A06", "tip_without_stop", waves.Bar(velocity=HAT, far="fixed")),
        (
            "A09",
            "fall_of_lower_end",
            waves.Bar(
                length=10.0,
                youngs=900.0,
                acceleration=10.0,
                gap=5.0,
                velocity=((0.0, 10.0, 0.0, 0.0),),
                strain=((0.0, 10.0, 0.0, 0.0),),
            ),
        ),
        ("A11", "tip", waves.Bar(strain=((0.0, 1.0, 0.5, 0.5),), tip=-0.5, gap=0.0, far="fixed")),
    ],
)
def test_tables_of_the_continuum(name: str, column: str, bar: waves.Bar) -> None:
    reference = CASES[name]["reference"]
    times = np.array(reference["times"])
    sign = -1.0 if name == "A11" else 1.0
    np.testing.assert_allclose(sign * waves.solve(bar, times[-1] + 1.0).tip(times), reference[column], atol=1e-11)


@pytest.mark.parametrize(
    ("name", "bar", "touch", "release", "force"),
    [
        (
            "A10",
            Thrown(length=10.0, youngs=3e7, density=0.73, speed=202.2, gap=0.01),
            "t_impact",
            "t_release",
            "mean contact force",
        ),
        (
            "A12",
            Thrown(youngs=210e9, density=7800.0, area=3.14e-4, speed=0.1, gap=5e-5),
            "t_contact",
            "t_release",
            "mean force",
        ),
    ],
)
def test_thrown_bars_in_units(name: str, bar: Thrown, touch: str, release: str, force: str) -> None:
    found = (value(name, touch), value(name, release), value(name, force))
    assert found == pytest.approx((bar.touch, bar.release, bar.force), rel=1e-12)


def test_the_cases_of_hertz_and_lame_are_the_closed_forms() -> None:
    half, peak, force = (
        b03_cylinder_on_plane.HERTZ.half_width,
        b03_cylinder_on_plane.HERTZ.peak,
        b04_hemisphere_on_plane.hertz().force,
    )
    assert (value("B03", "b"), value("B03", "p0"), value("B04", "F")) == pytest.approx((half, peak, force), rel=1e-12)
    assert value("B04", "p0") == pytest.approx(b04_hemisphere_on_plane.hertz().peak, rel=1e-12)
    impact = b05_ball_impact.exact(1.0)
    found = [value("B05", name) for name in ("contact duration", "F_max", "delta_max")]
    assert found == pytest.approx([impact.duration, impact.force, impact.approach], rel=1e-9)
    assert value("B06", "p") == pytest.approx(b06_press_fit.EXACT.pressure, rel=1e-12)


def test_the_cases_of_bars_that_collide_are_the_closed_forms() -> None:
    assert value("B02", "duration") == pytest.approx(b02_plane_wave.DURATION, rel=1e-12)
    assert value("B02", "mean interface pressure over contact") == pytest.approx(b02_plane_wave.PRESSURE, rel=1e-12)
    for case in "ac":
        assert value("A08", f"{case}: v_after") == pytest.approx(a08_unequal_bars.VELOCITY[case], rel=1e-12)
    assert value("A08", "b: force") == pytest.approx(a08_unequal_bars.FORCE["b"][0], rel=1e-12)


def test_d01_and_d10_are_the_stresses_of_simple_shear() -> None:
    for rate, rows in CASES["D01"]["reference"]["table"].items():
        gamma, s11, s12 = np.array(rows).T
        np.testing.assert_allclose(shear.elastic(rate, gamma)[:2], [s11, s12], rtol=1e-12)
    names = ("s11 at gamma=5,k=.1", "s12 at gamma=5, k=.1")
    steady = shear.plastic(0.1, np.array([1.0, 5.0]))[:, -1]
    np.testing.assert_allclose(steady, [value("D10", name) for name in names], rtol=1e-7)


def test_forming_is_in_closed_form() -> None:
    reduction, force, _ = np.array(CASES["E01"]["reference"]["table"]).T
    np.testing.assert_allclose(flow.upsetting(reduction, 0.3), force, rtol=1e-12)
    thick, thin = np.array(CASES["E05"]["reference"]["table"]).T
    np.testing.assert_allclose(flow.neck(thick, 0.3), thin, rtol=1e-12)
    assert flow.siebel(0.05, 1.0, 1.0) == pytest.approx(value("E06", "p_mean R/H=1"), rel=1e-9)


QUANTITIES = [
    {"name": "a", "value": 2.0, "tol_rel": 0.01},
    {"name": "b", "value": [0.0, -4.0], "tol_abs": 0.01, "tol_rel": 0.01},
    {"name": "c", "value": 0.0, "tol_rel": 0.1},
]


@pytest.mark.parametrize(
    ("results", "verdicts"),
    [
        ({"a": 2.019, "b": [0.03, -4.0], "c": -0.1}, [True, True, True]),
        ({"a": 2.021, "b": [0.05, -4.0], "c": 0.11}, [False, False, False]),
        ({"a": float("nan"), "b": [0.0, -4.0, 0.0]}, [False, False, None]),
        ({"a": [2.0], "b": -4.0, "more": 1.0}, [True, False, None]),
    ],
)
def test_checker(results: dict, verdicts: list[bool | None]) -> None:
    found = verify.compared({"qoi": QUANTITIES}, results)
    assert [None if q.value is None else q.passed for q in found] == verdicts
    assert not any(q.passed for q in found if q.value is None)


def test_checker_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results = tmp_path / "results.json"
    case = str(FOLDER / "waves" / "A12.json")
    for given, code in (({"t_contact": 5e-4}, 0), ({"t_contact": 5.1e-4}, 1), ({}, 1)):
        results.write_text(json.dumps(given))
        assert check_case.main([case, str(results)]) == code
    assert "Steel bar" in capsys.readouterr().out
    assert check_case.main([]) == 2
