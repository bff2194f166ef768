"""Bad input from the command line: exit code 2, the path, the value, a remedy, and no folder left behind."""

from pathlib import Path

import pytest

from softway.apps.cli import main

BLOCK = """
[bodies.block]
kind = "Solid"
mesh = { kind = "Box", size = ["2 cm", "2 cm", "2 cm"], cells = [2, 2, 2] }
material = { kind = "NeoHookean", E = "210 GPa", nu = 0.3 }
density = "7850 kg/m^3"
velocity = [0, 0, "-1 m/s"]
place = { bottom = "0.1 mm" }
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0, 0], normal = [0, 0, 1] }
[[contacts]]
name = "floor"
between = ["block.bottom", "floor"]
[time]
end = "10 us"
"""
INVERTED = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
1
1 4 2 1 1 1 3 2 4
$EndElements
"""
# What is changed, "&" between several; then what the message must contain: the path, the value, the remedy.
CASES = {
    "unknown key": ("bodies.block.material.nuu=0.3", "bodies.block.material.nuu", "0.3", "did you mean 'nu'"),
    "wrong unit": ("bodies.block.material.E=210 mm", "bodies.block.material.E", "210 mm", "210 GPa"),
    "negative density": ("bodies.block.density=-7850 kg/m^3", "bodies.block.density", "-7850", "7850 kg/m^3"),
    "missing mesh file": (
        "bodies.block.mesh={kind='MeshFile', path='none.msh'}",
        "bodies.block.mesh.path",
        "none.msh",
        ".msh or .inp",
    ),
    "tag that matches nothing": (
        "contacts[0].between=['block.botom', 'floor']",
        "contacts[0].between",
        "botom",
        "bottom",
    ),
    "inverted element": (
        "bodies.block.mesh={kind='MeshFile', path='inverted.msh'}",
        "bodies.block.mesh",
        "inverted cell",
        "positive volume",
    ),
    "unconstrained static start": (
        "contacts=[] & start={kind='StaticStart', loads=[{kind='Gravity', acceleration=[0, 0, -9.81]}]}",
        "bodies.block.supports",
        "translation along x",
        "sufficient supports",
    ),
    "overlapping start": (
        "bodies.block.place.bottom=-0.5 mm",
        "contacts[0].between",
        "0.0005 m inside",
        "move a body",
    ),
    "unknown body": ("contacts[0].between=['blok.bottom', 'floor']", "contacts[0].between", "blok", "'block'"),
    "no end": ("time.end=0", "time.end", "0 s", "2 ms"),
    "unknown kind": ("bodies.block.material.kind=NeoHook", "bodies.block.material.kind", "NeoHook", "NeoHookean"),
    "load inside a body": (
        "bodies.block.loads=[{kind='Gravity', acceleration=[0, 0, -9.81]}]",
        "bodies.block.loads",
        "unknown key",
        "at the top level of the file",
    ),
    "unknown key without a kind": (
        "bodies.block.supports=[{on='bottom', axes='x'}]",
        "bodies.block.supports[0].axes",
        "unknown key",
        "components",
    ),
    "probe of nothing": (
        "output.probes=[{name='p', of='block', tag='lid', component='z'}]",
        "output.probes[0].tag",
        "lid",
        "top",
    ),
}


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    (tmp_path / "inverted.msh").write_text(INVERTED)
    file = tmp_path / "block.toml"
    file.write_text(BLOCK)
    return file


@pytest.mark.parametrize("case", CASES)
def test_bad_input_leaves_nothing_behind(case, scenario, refused):
    refused(scenario, *CASES[case])


def test_the_scenario_itself_is_right(scenario):
    assert main(["check", str(scenario), "--quiet"]) == 0


def test_a_path_that_does_not_exist(scenario, capsys):
    assert main(["check", str(scenario), "--set", "bodies.blok.density=1"]) == 2
    assert "bodies.blok.density" in "".join(capsys.readouterr())


def test_a_file_that_does_not_exist(tmp_path, capsys):
    assert main(["run", str(tmp_path / "none.toml")]) == 2
    assert "none.toml" in "".join(capsys.readouterr())


WRITTEN = {
    "a mark of bytes first": (lambda text: "\ufeff" + text, None),
    "no quotes": (lambda text: text.replace('"Solid"', "Solid"), "kind = Solid"),
    "unit outside of quotes": (lambda text: text.replace('"7850 kg/m^3"', "7850 kg/m^3"), "density = 7850 kg/m^3"),
    "decimal comma": (lambda text: text.replace('"7850 kg/m^3"', '"7850,5 kg/m^3"'), "a decimal point instead of"),
    "a table twice": (lambda text: text + '[time]\nend = "1 us"\n', "[time]"),
}


@pytest.mark.parametrize("case", WRITTEN)
def test_what_is_written_is_shown_where_it_is_wrong(case, scenario, capsys):
    change, told = WRITTEN[case]
    scenario.write_text(change(BLOCK), encoding="utf-8")
    assert main(["check", str(scenario), "--quiet"]) == (2 if told else 0)
    assert told is None or told in " ".join(capsys.readouterr().err.split())


def test_a_shape_in_place_of_its_tool_is_answered_with_the_tool(scenario, capsys):
    scenario.write_text(BLOCK.replace('"Tool"\nshape = { kind = "HalfSpace",', '"HalfSpace"\n# {'), encoding="utf-8")
    assert main(["check", str(scenario), "--quiet"]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert (
        """bodies.floor.kind: 'HalfSpace' is unknown try: kind = "Tool" with shape = { kind = "HalfSpace", ... }"""
        in told
    )


def test_a_name_without_its_ending_is_answered_with_the_file(scenario, capsys):
    assert main(["run", str(scenario.with_suffix(""))]) == 2
    assert "try: block.toml, which exists" in " ".join(capsys.readouterr().err.split())


def test_a_folder_below_a_file_is_refused_before_anything_runs(scenario, capsys):
    assert main(["run", str(scenario), "--out", str(scenario / "run")]) == 2
    assert "block.toml' is a file" in " ".join(capsys.readouterr().err.split())


def test_an_unknown_option_is_answered_with_the_help_of_its_verb(capsys):
    assert main(["run", "x.toml", "--ot", "y"]) == 2
    assert "softway run --help" in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("mesh", "told"),
    [("hello", "begins with 'hello', not with $MeshFormat"), (INVERTED.replace("2 1 0 0", "2 nan 0 0"), "node 1")],
)
def test_an_unreadable_mesh_is_refused_with_the_reason(mesh, told, scenario, capsys):
    (scenario.parent / "bad.msh").write_text(mesh)
    assert main(["check", str(scenario), "--set", "bodies.block.mesh={kind='MeshFile', path='bad.msh'}"]) == 2
    assert told in " ".join(capsys.readouterr().err.split())


def test_what_is_too_large_for_the_machine_is_refused(scenario, capsys, monkeypatch):
    def exhausted(_):
        raise MemoryError("Unable to allocate 1.43 GiB")

    monkeypatch.setattr("softway.apps.cli.output.reading.check", exhausted)
    assert main(["run", str(scenario), "--out", str(scenario.parent / "run")]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert "1.43 GiB" in told and "try: fewer cells" in told and not (scenario.parent / "run").exists()
