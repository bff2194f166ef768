"""Conductors from scenario files: records, fields, resumption bit by bit, pictures and pages, refusals."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import erf, erfc

import softway as sw
from softway.apps.cli.commands import main
from softway.errors import InputError
from softway.record.view.options import PictureOptions
from softway.record.view.page import page
from softway.record.view.pictures import picture
from softway.record.write.fields import FILE as FIELDS

POND = """
title = "A pond freezes"
[bodies.pond]
kind = "Conductor"
mesh = { kind = "Rectangle", size = ["20 mm", "10 mm"], cells = [8, 4] }
density = "1000 kg/m^3"
temperature = "1 degC"
[bodies.pond.law]
conductivity = "2.22 W/(m*K)"
capacity = "1.762 kJ/(kg*K)"
latent = { heat = "338 kJ/kg", melting = "0 degC", liquid = { conductivity = 0.556, capacity = 4226 } }
[[loads]]
kind = "Temperature"
on = "pond.left"
value = "-10 degC"
[[loads]]
kind = "HeatSource"
of = "pond"
value = "1 kW/m^3"
[[loads]]
kind = "Convection"
on = "pond.top"
coefficient = "20 W/(m^2*K)"
ambient = "-15 degC"
[output]
fields_every = "50 s"
[[output.probes]]
name = "corner"
of = "pond"
at = ["20 mm", "10 mm"]
quantity = "temperature"
[[output.probes]]
name = "right"
of = "pond"
tag = "right"
quantity = "temperature"
[time]
end = "200 s"
step = "10 s"
"""
BAR = """
[bodies.bar]
kind = "Conductor"
mesh = { kind = "Interval", length = 1, cells = 10 }
density = 1
temperature = 300
law = { conductivity = 2, capacity = 1 }
[[loads]]
kind = "HeatFlux"
on = "bar.left"
value = 6
[[loads]]
kind = "Temperature"
on = "bar.right"
value = 300
[output]
fields_every = 1
[time]
end = 5
step = 0.05
"""
CORNER = Path(__file__).parents[4] / "scenarios" / "freezing_corner.toml"
TABLES = ("history.csv", "events.csv", "conductors.json", FIELDS)


FRONT = """
title = "A bar freezes from its end"
[bodies.bar]
kind = "Conductor"
mesh = { kind = "Interval", length = "10 cm", cells = 10 }
density = "1000 kg/m^3"
temperature = "5 degC"
latent = "front"
[bodies.bar.law]
conductivity = "2.22 W/(m*K)"
capacity = "1762 J/(kg*K)"
latent = { heat = "338 kJ/kg", melting = "0 degC", liquid = { conductivity = 0.556, capacity = 4226 } }
[[loads]]
kind = "Temperature"
on = "bar.left"
value = "-10 degC"
[time]
end = "2000 s"
step = "50 s"
"""


@pytest.fixture(scope="module")
def pond(tmp_path_factory) -> sw.Run:
    return sw.run(sw.loads(POND), tmp_path_factory.mktemp("runs") / "pond")


@pytest.fixture(scope="module")
def bar(tmp_path_factory) -> sw.Run:
    return sw.run(sw.loads(BAR), tmp_path_factory.mktemp("runs") / "bar")


@pytest.fixture(scope="module")
def molten(tmp_path_factory) -> sw.Run:
    """Half of a bar melts: two of four cells are solid at the end, and one is cut."""
    law = "{conductivity=60, capacity=1, latent={heat='60 kJ/kg', melting='232 degC'}}"
    changes = (
        "bodies.bar.mesh.length=2 cm", "bodies.bar.mesh.cells=4", "bodies.bar.density=7300", f"bodies.bar.law={law}",
        "bodies.bar.temperature=231.99 degC", "loads=[{kind='HeatFlux', on='bar.left', value='100 kW/m^2'}]",
        "time={end='40 s', step='1 s'}", "output.fields_every=10 s",
    )  # fmt: skip
    return sw.run(sw.loads(FRONT, changes=changes), tmp_path_factory.mktemp("runs") / "molten")


def test_records_are_those_of_the_march_in_python(pond):
    given = sw.loads(POND)
    steps = list(sw.heat.march_heat(sw.heat.HeatScene(bodies=given.bodies, loads=given.loads), until=200.0, step=10.0))
    history = pond.history
    assert history["time"][0] == 0.0 and history["time"][1:].tolist() == [step.time for step in steps]
    assert history["heat_content"][1:].tolist() == [step.ledger.heat_content for step in steps]
    assert history["liquid.pond"][1:].tolist() == [step.liquid_volume["pond"] for step in steps]
    temperature = steps[-1].temperature["pond"]
    mesh = given.bodies["pond"].mesh.build()
    assert history["corner"][-1] == temperature[mesh.nearest((0.02, 0.01))]
    assert history["right"][-1] == pytest.approx(temperature[mesh.nodes("right")].mean(), abs=1e-10)
    assert pond.fields.times.tolist() == [0.0, 50.0, 100.0, 150.0, 200.0]
    assert pond.fields[-1]["temperature"].tolist() == temperature.tolist()
    assert pond.fields[-1]["liquid"].tolist() == steps[-1].liquid["pond"].tolist()
    assert not pond.fields[-1].displacement.any() and np.isnan(pond.fields[-1].stress).all()


def test_each_load_has_a_column_by_its_number(pond):
    history = pond.history
    assert history["heat.1"][-1] == pytest.approx(1e3 * 0.02 * 0.01 * 200.0, rel=1e-12)
    assert history["heat.0"][-1] < 0.0 and history["heat.2"][-1] < 0.0
    total = sum(history[f"heat.{k}"] for k in range(3))
    assert total == pytest.approx(history["heat_content"] - history["heat_content"][0], rel=1e-9)
    assert history["heat_error_relative"].max() < 1e-11
    found = pond.summary
    assert found["slabs"] == 20 and found["liquid"]["pond"] == history["liquid.pond"][-1]


def test_the_heat_flux_of_the_cells_is_that_of_the_surface(bar):
    """Steady after five times the time of diffusion."""
    assert bar.fields[-1]["heat_flux"][:, 0] == pytest.approx(np.full(10, 6.0), rel=1e-5)
    assert not bar.fields[-1]["heat_flux"][:, 1:].any()
    assert bar.fields[-1]["temperature"] == pytest.approx(303.0 - 3.0 * np.linspace(0.0, 1.0, 11), abs=1e-4)


@pytest.mark.parametrize("after", [1, 7])
def test_a_resumed_run_has_the_same_bits(pond, tmp_path, after):
    seen = []

    def stop(progress):
        seen.append(progress)
        if len(seen) == after + 1:
            raise KeyboardInterrupt

    folder = tmp_path / "stopped"
    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.loads(POND), folder, progress=stop)
    assert sw.Run(folder).history.rows == after + 1
    resumed = sw.resume(folder)
    assert resumed.stop == pond.stop
    for name in TABLES[:3]:
        assert (folder / name).read_bytes() == (pond.path / name).read_bytes(), name
    assert resumed.fields.times.tolist() == pond.fields.times.tolist()
    for mine, other in zip(resumed.fields, pond.fields, strict=True):
        assert all((mine[name] == other[name]).all() for name in ("temperature", "liquid", "heat_flux"))


def test_a_front_between_nodes_is_resumed_with_the_same_bits(tmp_path):
    whole, seen = sw.run(sw.loads(FRONT), tmp_path / "whole"), []

    def stop(progress):
        seen.append(progress)
        if len(seen) == 23:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.loads(FRONT), tmp_path / "stopped", progress=stop)
    resumed = sw.resume(tmp_path / "stopped")
    assert (resumed.path / "history.csv").read_bytes() == (whole.path / "history.csv").read_bytes()
    assert 0.01 < 0.1 - whole.history["liquid.bar"][-1] < 0.02
    assert whole.history["heat_error_relative"].max() < 1e-12


def test_frames_have_the_liquid_share_of_a_front(molten):
    """A bar of little capacity just below melting: the heat that came in is latent but for a thousandth, and as much
    of it flows through a cell as there is liquid in it.
    """
    told = dict(zip(molten.history["time"].tolist(), molten.history["liquid.bar"], strict=True))
    for frame in molten.fields:
        molten = 1e5 * frame.time / (7300.0 * 6e4)
        shares = np.clip((molten - 0.005 * np.arange(4)) / 0.005, 0.0, 1.0)
        assert frame["liquid"] == pytest.approx(shares, abs=2e-3), frame.time
        assert 0.005 * frame["liquid"].sum() == pytest.approx(told[frame.time], abs=1e-15)
        assert frame["heat_flux"][:, 0] == pytest.approx(1e5 * shares, abs=300.0), frame.time


def test_the_heat_flux_of_frames_is_that_of_both_phases(tmp_path):
    """Between a warm and a cold wall, at last, the same heat flows through the liquid, the front and the solid."""
    ends = (("left", 293.15), ("right", 263.15))
    loads = ", ".join(f"{{kind='Temperature', on='bar.{end}', value={value}}}" for end, value in ends)
    changes = (f"loads=[{loads}]", "bodies.bar.law.latent.heat=3 kJ/kg", "time={end=40000, step=400}")
    run = sw.run(sw.loads(FRONT, changes=(*changes, "output.fields_every=40000")), tmp_path / "run")
    front = 0.1 * 0.556 * 20.0 / (0.556 * 20.0 + 2.22 * 10.0)
    last = run.fields[-1]
    assert 0.01 * last["liquid"].sum() == pytest.approx(front, rel=1e-5)
    assert last["heat_flux"][:, 0] == pytest.approx(np.full(10, 0.556 * 20.0 / front), rel=1e-4)


def test_the_scenario_in_the_folder_is_the_one_that_was_read(pond):
    again = sw.loads(pond.scenario)
    assert again.bodies["pond"].law == sw.loads(POND).bodies["pond"].law and again.loads == sw.loads(POND).loads
    assert again.bodies["pond"].temperature == pytest.approx(274.15)


@pytest.mark.slow
@pytest.mark.parametrize("which", ["pond", "bar"])
def test_pictures_and_pages(which, request, tmp_path):
    run = request.getfixturevalue(which)
    for what in ("bodies", "history"):
        assert picture(run, what).save(tmp_path / f"{what}.png").stat().st_size > 5000
    assert "<img" in page(run, ("Told.",))


def curves(run, field, *times):
    """Label and curves of the picture of a field along bars."""
    axis = picture(run, "bodies", PictureOptions(field=field, times=times)).figure.axes[0]
    return axis.get_ylabel(), [line.get_xydata() for line in axis.get_lines()]


def test_a_picture_of_bars_has_the_field_that_is_wanted(molten):
    """Cells have one value from end to end, in the units of the labels: 100 kW/m^2 flow into 9.13 mm of liquid."""
    length = 1e5 * 40.0 / (7300.0 * 6e4)
    label, (liquid,) = curves(molten, "liquid", 40.0)
    share = (length - 0.005) / 0.005
    assert label == "liquid" and liquid[:, 0] == pytest.approx([0, 5, 5, 10, 10, 15, 15, 20])
    assert liquid[:, 1] == pytest.approx([1.0, 1.0, share, share, 0.0, 0.0, 0.0, 0.0], abs=2e-3)
    label, (start, end) = curves(molten, "heat_flux.x", 0.0, 40.0)
    assert label == "heat flux x [kW/m²]" and start[:, 1] == pytest.approx(np.zeros(8), abs=1e-10)
    assert end[[0, 2, 4], 1] == pytest.approx([100.0, 100.0 * share, 0.0], abs=0.3)
    label, (line,) = curves(molten, None, 40.0)
    assert label == "temperature [K]" and line[:, 0] == pytest.approx([0, 5, 10, 15, 20])
    assert line[0, 1] == pytest.approx(505.15 + 1e5 * length / 60.0, abs=0.05)


@pytest.mark.parametrize("more", [(), ("--film", "bar.gif")])
def test_a_field_that_bars_have_not_is_named(molten, more, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["plot", str(molten.path), "--field", "nonsense", *more]) == 2
    told = " ".join("".join(capsys.readouterr()).split())
    assert "no field 'nonsense'" in told and "heat_flux, liquid" in told and not list(tmp_path.glob("*.*"))
    assert main(["plot", str(molten.path), "--field", "liquid", "--dpi", "40", *more]) == 0


def test_the_command_line_runs_it_to_the_end(tmp_path, capsys):
    file = tmp_path / "bar.toml"
    file.write_text(BAR, encoding="utf-8")
    folder = str(tmp_path / "out")
    assert main(["run", str(file), "--out", folder]) == 0
    assert main(["audit", folder]) == 0 and main(["show", folder]) == 0
    told = capsys.readouterr().out
    assert "came in" in told and "balance of heat holds" in told
    assert main(["race", str(file)]) == 2 and main(["export", folder, "--to", "x.csv"]) == 2


@pytest.mark.slow
def test_the_shipped_corner_freezes_as_neumann_found_far_from_it():
    """Ice between the front and a wall, in the row of cells that is farthest from the other wall."""
    scene = sw.load(CORNER, ("bodies.water.mesh.cells=[24,24]", "time.end=10 min"))
    run = sw.run(scene)
    frozen = 1.0 - run.fields[-1]["liquid"].reshape(24, 24)
    ice = frozen[-1].sum() * 0.04 / 24
    alpha = 2.22 / (1000.0 * 1762.0)

    def miss(x):
        solid = np.exp(-(x**2)) / erf(x)
        y = x * np.sqrt(alpha / (0.556 / 4.226e6))
        liquid = 0.556 / 2.22 * (y / x) * 0.2 * np.exp(-(y**2)) / erfc(y)
        return solid - liquid - x * 338e3 * np.sqrt(np.pi) / (1762.0 * 10.0)

    assert ice == pytest.approx(2.0 * brentq(miss, 0.05, 0.5) * np.sqrt(alpha * 600.0), rel=0.03)
    assert frozen == pytest.approx(frozen.T, abs=0.05)
    assert frozen.trace() * 0.04 / 24 > 1.2 * ice


def test_bodies_that_touch_exchange_heat(tmp_path):
    more = """
[bodies.rod]
kind = "Conductor"
mesh = { kind = "Interval", length = 1, cells = 7, origin = 1 }
density = 1
temperature = 400
law = { conductivity = 3, capacity = 1 }
[[heat_contacts]]
between = ["bar.right", "rod.left"]
conductance = 5
"""
    run = sw.run(sw.loads(BAR + more, changes=("loads=[]", "time.end=40")))
    history = run.history
    assert history["passed.0"][-1] == pytest.approx(-50.0, rel=1e-6)
    assert abs(history["heat_error"][-1]) < 1e-9 and history["entropy_produced"].min() > -1e-12
    with pytest.raises(InputError) as found:
        sw.check(sw.loads(BAR + more.replace("rod.left", "rod.right")))
    assert found.value.where == "heat_contacts[0].between"
    lonely = (
        SOLID
        + """
[time]
end = 1
[[heat_contacts]]
between = ["block.left", "other.right"]
conductance = 1
"""
    )
    with pytest.raises(InputError, match="conductors only"):
        sw.check(sw.loads(lonely))


SOLID = """
[bodies.block]
mesh = { kind = "Interval", length = 1, cells = 2 }
material = { kind = "LinearElastic", E = 1, nu = 0 }
density = 1
"""
WRONG = [
    (SOLID, (), "bodies.block.kind", "conductors only"),
    ("", ("bodies.bar.law.capacity=0",), "bodies.bar.law.capacity", "positive"),
    ("", ("bodies.bar.temperature=-10",), "bodies.bar.temperature", "kelvin"),
    ("", ('loads=[{kind="Temperature",on="bar.right",value=-5}]',), "loads[0].value", "kelvin"),
    ("", ('loads=[{kind="Traction",on="bar.right",value=-5}]',), "loads[0]", "conductors only"),
    ("", ('loads=[{kind="HeatFlux",on="rod",value=5}]',), "loads[0].on", "'bar'"),
    ("", ('bodies.bar.law.latent={heat=1,melting="0 degC",half_range="1 degC"}',), "half_range", "difference"),
    (
        "",
        ("bodies.bar.law.latent={heat=1,melting=300,liquid={capacity=1}}",),
        "liquid.conductivity",
        "add conductivity",
    ),
    ("", ('output.probes=[{name="a",of="bar",tag="left"}]',), "output.probes[0].quantity", "temperature"),
    ("", ('output.probes=[{name="a",of="rod",tag="left",quantity="temperature"}]',), "output.probes[0].of", "bar"),
    ("", ('time.step="auto"',), "time.step", "a time such as"),
    ("", ('ties=[{between=["bar.left","bar.right"]}]',), "ties[0]", "heat_contacts"),
]


@pytest.mark.parametrize(("more", "changes", "where", "remedy"), WRONG)
def test_what_is_refused(more, changes, where, remedy):
    with pytest.raises(InputError) as found:
        sw.check(sw.loads(BAR + more, changes=changes))
    assert where in found.value.where and remedy in f"{found.value.problem} {found.value.remedy}"


def test_heat_on_solids_is_refused():
    text = SOLID + '[[loads]]\nkind = "HeatFlux"\non = "block.left"\nvalue = 1\n[time]\nend = 1\n'
    with pytest.raises(InputError, match="the key thermal") as found:
        sw.check(sw.loads(text))
    assert found.value.where == "loads[0]"


def test_a_conductor_without_loads_has_a_note():
    assert "nothing will happen" in str(sw.check(sw.loads(BAR, changes=("loads=[]",))).notes[0])
