"""Bodies of several materials in scenario files: laws and densities by regions, the records of a run."""

import h5py
import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.laws.materials import find
from softway.scenario.files import dumps, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.json_schema import schema

UNITS = Units.standard()
TEXT = """
[bodies.block]
kind = "Solid"
velocity = ["0 m/s", "-60 m/s"]
mass = "Lumped"

[bodies.block.mesh]
kind = "Divided"
mesh = { kind = "Rectangle", size = ["20 mm", "20 mm"], cells = [4, 4], origin = ["0 mm", "0.1 mm"] }
regions = { skin = { kind = "InBox", high = ["1 m", "10.1 mm"] } }
rest = "core"

[bodies.block.material]
skin = { library = "copper", law = "plastic" }
core = "glass"

[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0], normal = [0, 1] }

[[contacts]]
between = ["block.bottom", "floor"]

[time]
end = "8 us"
step = "0.4 us"

[output]
fields_every = "4 us"
"""


def block(*changes: str, text: str = TEXT) -> sw.Solid:
    return loads(text, changes=changes, units=UNITS).bodies["block"]


def test_names_give_laws_and_densities_by_regions() -> None:
    copper, glass = find("copper"), find("glass")
    solid = block()
    assert solid.material == {"skin": copper.plastic(), "core": glass.elastic()}
    assert solid.density == {"skin": copper.density, "core": glass.density}


def test_given_densities_stay() -> None:
    assert block("bodies.block.density=7 kg/m^3").density == 7.0
    assert block("bodies.block.density.core=7 kg/m^3").density == {"skin": find("copper").density, "core": 7.0}


def test_a_law_of_a_region_by_its_kind_or_with_other_numbers() -> None:
    solid = block("bodies.block.material.core={kind='LinearElastic', E='2 GPa'}", "bodies.block.density=1 kg/m^3")
    assert solid.material["core"] == sw.LinearElastic(E=2e9)
    assert block("bodies.block.material.core.nu=0.25").material["core"].nu == 0.25


def test_the_text_of_a_scenario_is_read_again() -> None:
    scenario = loads(TEXT, units=UNITS)
    assert loads(dumps(scenario), units=UNITS) == scenario


@pytest.mark.parametrize(
    ("change", "where", "told"),
    [
        ("bodies.block.material.core=glas", "bodies.block.material.core", "not a material"),
        ("bodies.block.material.core={kind='Elastik'}", "bodies.block.material.core.kind", "unknown"),
        ("bodies.block.material.core={kind='LinearElastic', E='1 m'}", "bodies.block.material.core.E", "GPa"),
        ("bodies.block.material.core={kind='LinearElastic', E=1}", "bodies.block.density.core", "missing"),
        ("bodies.block.material={E='2 GPa', nu=0.3}", "bodies.block.density", "missing"),
    ],
)
def test_mistakes_are_told_with_the_region(change: str, where: str, told: str) -> None:
    with pytest.raises(InputError, match=told) as found:
        block(change)
    assert found.value.where == where


def test_the_schema_admits_laws_by_regions() -> None:
    made = schema()["$defs"]["bodies.solid.Solid"]["properties"]
    tables = [one for one in made["material"]["anyOf"] if one.get("type") == "object" and "additionalProperties" in one]
    assert tables and "library" in repr(tables[0])
    assert any(one.get("type") == "object" for one in made["density"]["anyOf"])


def test_the_fields_of_a_run_hold_materials_and_histories(tmp_path) -> None:
    run = sw.run(loads(TEXT, units=UNITS), tmp_path / "run")
    mesh = loads(TEXT, units=UNITS).bodies["block"].mesh.build()
    with h5py.File(run.path / "fields.vtkhdf") as file:
        data = {name: np.array(file["VTKHDF/CellData"][name]) for name in ("material", "plastic_strain", "von_mises")}
    last = {name: values[-mesh.n_cells :] for name, values in data.items()}
    assert set(last["material"][mesh.cells("skin")]) == {1.0} and set(last["material"][mesh.cells("core")]) == {2.0}
    assert last["plastic_strain"][mesh.cells("skin")].max() > 1e-4
    assert last["plastic_strain"][mesh.cells("core")].max() == 0.0
    assert last["von_mises"].min() > 0.0
    assert run.summary["energy_error_relative"] < 1e-11 and run.summary["dissipation"] > 0.0


def test_a_stopped_run_is_resumed_with_the_same_bits(tmp_path) -> None:
    scenario = loads(TEXT, units=UNITS)
    whole = sw.run(scenario, tmp_path / "whole")

    def stop(progress: sw.Progress) -> None:
        if progress.slabs == 9:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(scenario, tmp_path / "stopped", progress=stop)
    resumed = sw.resume(tmp_path / "stopped")
    assert resumed.stop == whole.stop
    for name in ("energy_strain", "dissipation", "energy_kinetic", "contact.block.bottom-floor.force_n"):
        assert np.array_equal(whole.history[name], resumed.history[name])
