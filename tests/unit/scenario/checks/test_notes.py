"""Notes of a check: said for meshes and contacts in doubt, silent for the others, and repeated by the summary."""

import json
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.apps.verify.cases.contact.b06_press_fit import EXACT, SIDES, Fitted, rings
from softway.meshes.generators.shapes import rectangle

TWO_PARTS = sw.Mesh(
    points=np.concatenate([rectangle((1.0, 1.0), (2, 2)).points + [x, 0.0] for x in (0.0, 1.0)]),
    blocks={"quad4": np.concatenate([rectangle((1.0, 1.0), (2, 2)).blocks["quad4"] + k for k in (0, 9)])},
)


def checked(facets: tuple[int, int], cell: str = "quad4", **given: object) -> tuple[str, ...]:
    """Notes on the press fit of B06 with these numbers of facets, as text."""
    law = sw.LinearElastic(E=210e9, nu=0.3)
    supports = (sw.Fixed(on="start", components="y"), sw.Fixed(on="end", components="x"))
    bodies = {
        name: sw.Solid(mesh=mesh, material=law, density=7850.0, section=sw.bodies.PlaneStress(), supports=supports)
        for name, mesh in zip(SIDES, rings(facets, cell), strict=True)
    }
    contact = sw.Contact(between=("inner.outer", "outer.inner"), name="fit", start="fit", **given)
    found = sw.check(sw.Scenario(bodies=bodies, contacts=(contact,), time=sw.Time(end=1e-6)))
    return tuple(str(note) for note in found.notes)


def error(facets: tuple[int, int], method: sw.contact.NodeToSurface | None = None) -> float:
    """Greater error of the mean pressure of both rings, relative to Lame."""
    found = Fitted.of(rings(facets), method)
    means = []
    for ring in SIDES:
        force, length = found.force(ring)
        means.append(force.sum() / length.sum())
    return max(abs(p / EXACT.pressure - 1.0) for p in means)


def test_press_fit_whose_facets_do_not_match_is_noted_with_the_numbers() -> None:
    """The pressure is wrong by a tenth and more, with a clean certificate; each remedy leads to the right pressure."""
    nodes = sw.contact.NodeToSurface()
    (note,) = checked((40, 32), method=nodes)
    assert note.startswith("contacts[0].between: the facets of 'inner.outer' and 'outer.inner' stand up to 5.")
    assert "the interference is 1e-05 m (58% of it)" in note
    assert error((40, 32), nodes) > 0.1
    assert checked((40, 32)) == () and error((40, 32)) < 0.005  # DualMortar, the default
    assert checked((160, 128), method=nodes) == () and error((160, 128), nodes) < 0.3 * error((40, 32), nodes)


def test_mortar_is_no_remedy_for_rules_that_refuse_it() -> None:
    (note,) = checked((40, 32), timing=sw.contact.Impulse())
    assert "DualMortar" not in note and "the same nodes along both surfaces, or shorter edges" in note


@pytest.mark.slow
def test_quadratic_facets_are_curved_themselves() -> None:
    assert checked((40, 32), "quad9") == ()
    assert checked((40, 32), "quad9", method=sw.contact.NodeToSurface()) == ()


@pytest.mark.parametrize("gap", [0.0, 1e-3])
def test_flat_contact_has_no_notes(gap: float) -> None:
    blocks = {
        name: sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(n, n), origin=(0.0, y)),
            material=sw.LinearElastic(E=1.0),
            density=1.0,
        )
        for name, n, y in (("lower", 4, 0.0), ("upper", 3, 1.0 + gap))
    }
    contact = sw.Contact(between=("upper.bottom", "lower.top"))
    assert sw.check(sw.Scenario(bodies=blocks, contacts=(contact,), time=sw.Time(end=1.0))).notes == ()


def test_notes_stand_in_provenance_and_summary_of_a_run(tmp_path: Path) -> None:
    body = sw.Solid(mesh=TWO_PARTS, material=sw.LinearElastic(E=1.0), density=1.0)
    scenario = sw.Scenario(bodies={"plate": body}, time=sw.Time(end=0.2, step=0.1))
    (note,) = sw.check(scenario).notes
    assert note.where == "bodies.plate.mesh" and note.problem.startswith("2 parts that share no node; they touch at 6")
    run = sw.run(scenario, tmp_path / "run")
    (told,) = run.summary["notes"]
    assert told == {"where": note.where, "problem": note.problem, "remedy": note.remedy}
    assert run.provenance["notes"] == [told]
    (tmp_path / "run" / "summary.json").unlink()
    assert run.summary["notes"] == [told]


def test_check_run_and_show_print_notes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "two.msh"
    nodes = "\n".join(f"{k + 1} {x:g} {y:g} 0" for k, (x, y) in enumerate(TWO_PARTS.points))
    cells = "\n".join(
        f"{k + 1} 3 2 0 0 " + " ".join(str(n + 1) for n in row) for k, row in enumerate(TWO_PARTS.blocks["quad4"])
    )
    file.write_text(
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n18\n{nodes}\n$EndNodes\n$Elements\n8\n{cells}\n$EndElements\n"
    )
    scenario = tmp_path / "two.toml"
    scenario.write_text(
        '[bodies.plate]\nkind = "Solid"\nmesh = { kind = "MeshFile", path = "two.msh" }\n'
        'material = { kind = "LinearElastic", E = 1 }\ndensity = 1\n[time]\nend = 0.2\nstep = 0.1\n'
    )
    told = "note bodies.plate.mesh: 2 parts that share no node; they touch at 6 nodes"
    assert main(["check", str(scenario)]) == 0
    assert told in " ".join(capsys.readouterr().out.split())
    assert main(["run", str(scenario), "--out", str(tmp_path / "run")]) == 0
    assert " ".join(capsys.readouterr().out.split()).count(told) == 2  # with the scales, and with the summary
    assert main(["show", str(tmp_path / "run")]) == 0
    assert told in " ".join(capsys.readouterr().out.split())
    assert len(json.loads((tmp_path / "run" / "summary.json").read_text())["notes"]) == 1
    assert main(["check", "--quiet", str(scenario)]) == 0
    assert capsys.readouterr().out == ""


def test_an_equal_note_on_several_bodies_is_told_once() -> None:
    beam = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.05), cells=(10, 1)), material=sw.LinearElastic(E=1.0), density=1.0
    )
    notes = sw.check(sw.Scenario(bodies={"a": beam, "b": beam, "c": beam}, time=sw.Time(end=0.1))).notes
    assert [note.where for note in notes] == ["bodies.a.mesh"]
    assert notes[0].problem.endswith("(also b and c)")
