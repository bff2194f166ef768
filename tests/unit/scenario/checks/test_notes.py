"""Notes of a check: said for meshes in doubt, and repeated by the summary."""

import json
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.meshes.generators.shapes import rectangle

TWO_PARTS = sw.Mesh(
    points=np.concatenate([rectangle((1.0, 1.0), (2, 2)).points + [x, 0.0] for x in (0.0, 1.0)]),
    blocks={"quad4": np.concatenate([rectangle((1.0, 1.0), (2, 2)).blocks["quad4"] + k for k in (0, 9)])},
)


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
