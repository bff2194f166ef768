"""Every remedy of a refusal is tried: following it leads to a scenario that is right, or to a different message.

A refusal that no table tries, and that has no reason not to be tried here, fails the last test.
"""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType

import pytest
import remedy_files
import table_bodies
import table_contacts
import table_heat
import table_laws
import table_mechanisms
import table_members
import table_meshes
import table_obstacles
import table_piles
import table_python
import table_rigid
import table_text
import table_time
from try_it import Call, Try, refusal, sites

import softway
from softway.errors import InputError

pytestmark = pytest.mark.slow

TABLES: tuple[ModuleType, ...] = (
    table_bodies,
    table_contacts,
    table_heat,
    table_laws,
    table_mechanisms,
    table_rigid,
    table_piles,
    table_members,
    table_meshes,
    table_obstacles,
    table_python,
    table_text,
    table_time,
)
CASES: Mapping[str, Try | Call] = {
    f"{module.__name__}: {name}": case for module in TABLES for name, case in module.TABLE.items()
}
PARTS = (
    "bodies",
    "contact",
    "heat",
    "laws",
    "marching",
    "mechanisms",
    "meshes",
    "model",
    "obstacles",
    "piles",
    "scenario",
    "solve",
)
MODULES = (
    "errors.py",
    "record/write/heat/probes.py",
    "record/write/mechanism/probes.py",
    "record/write/probes.py",
    "record/storage/checkpoint.py",
)
ROBOTS = "an extra that is not always installed: tests/unit/mechanisms/test_robot_files.py"
INNER = "called inside only, after the check of what the user has given"
NEW_CELLS = "tests/unit/marching/remeshing/forming/test_new_cells.py"
BIMETALS = "from Python: tests/unit/marching/remeshing/forming/materials/test_warm_materials.py"
WARM = "from Python: tests/unit/marching/remeshing/forming/warm/test_warm_forging.py"
FORGED = "from Python: tests/unit/marching/remeshing/forming/test_forming_march.py"
DEVICE = "devices, with Warp and without: tests/unit/solve/device/test_device_input.py"
REASONS = {
    "bodies/setup/directions.py: _held": "nodes that a body carries: tests/unit/bodies/test_directed_supports.py",
    "bodies/assembled/nodal_masses.py: _require_even": "from Python: tests/unit/model/test_hanging_nodes.py",
    "bodies/inertia/mass_matrix.py: body_of": INNER,
    "bodies/inertia/mass_matrix.py: condensation": INNER,
    "bodies/inertia/mass_redistribution.py: redistribute_mass": INNER,
    "bodies/internal_force/inelastic/inelastic_force.py: inelastic_force": "a mesh admits no plates in space",
    "contact/assembly/declared.py: at_declared": "errors of others: tests/unit/contact/assembly/test_declared.py",
    "contact/mortar/linear_surface.py: linear_surface": INNER,
    "contact/assembly/methods.py: with_tool": "a closed surface that a tie covers: no rim is left",
    "contact/surfaces/boundary.py: __post_init__": INNER,
    "scenario/checks/check.py: _model": "ties of a mesh file: tests/unit/meshes/files/abaqus/test_ties.py",
    "heat/coupled/strain/expansion.py: thermal_stiffness": "a law of one's own that does not resist a change of volume",
    "solve/device/library.py: check_device": DEVICE,
    "solve/device/library.py: device_named": DEVICE,
    "solve/operators/device.py: require": DEVICE,
    "solve/operators/device.py: require_served": DEVICE,
    "scenario/run_ranks.py: require_ranks": "with --ranks only: tests/unit/ranks/test_launch.py",
    "scenario/run_ranks.py: ranks_of": "with --ranks of resume only: tests/unit/ranks/test_processes.py",
    "marching/state/march_state.py: fitting": "a state of another scene, from Python",
    "marching/state/model_state.py: join_states": "a state of another scene, from Python",
    "marching/rules/slab_rule.py: require_nodal": "unknowns from Python: tests/contracts/test_own_dofs.py",
    "marching/rules/slab_rule.py: require_motion_alone": "companion fields from Python",
    "marching/start/stored_state.py: _require": "damaged checkpoints",
    "mechanisms/contacts/impacts.py: start": "a scenario is refused before: tests/unit/mechanisms/test_stops.py",
    "mechanisms/arrays.py: restore": "states of other marches, from Python: tests/unit/mechanisms/test_march_state.py",
    "mechanisms/robots/model_members.py: _joint": ROBOTS,
    "mechanisms/robots/model_members.py: model_bodies": ROBOTS,
    "mechanisms/robots/robot_file.py: _compiled": ROBOTS,
    "mechanisms/robots/robot_file.py: _mujoco": ROBOTS,
    "mechanisms/robots/robot_file.py: read_robot": ROBOTS,
    "meshes/topology.py: require_none": "from Python: tests/unit/model/test_hanging_nodes.py",
    "meshes/adaptive/overlay.py: require_one_base": "from Python: tests/unit/meshes/adaptive/test_overlay.py",
    "meshes/adaptive/leaves.py: require_cover": "damaged states: tests/unit/marching/remeshing/test_continued.py",
    "meshes/adaptive/overlay.py: embedding": "from Python: tests/unit/meshes/adaptive/test_overlay.py",
    "meshes/adaptive/refinement.py: _require_bisected": "from Python: tests/unit/meshes/adaptive/test_refinement.py",
    "meshes/adaptive/refinement.py: refined": "from Python: tests/unit/meshes/adaptive/test_refinement.py",
    "meshes/files/abaqus/lexer.py: _lines": "millions of lines: tests/unit/meshes/files/abaqus/test_lexer.py",
    "meshes/files/abaqus/lexer.py: _admit": "many files: tests/unit/meshes/files/abaqus/test_lexer.py",
    "model/rigid/rigid_bodies.py: state_of": "a state of another scene, from Python",
    "model/rigid/rigid_refusals.py: _require_names": "from Python: tests/unit/marching/motion/test_rigid_contact.py",
    "model/build.py: with_dofs": "unknowns from Python: tests/contracts/test_own_dofs.py",
    "model/build.py: with_field": "companion fields from Python",
    "piles/ball_table.py: table_columns": "wrong tables: tests/unit/piles/test_groups.py",
    "piles/ball_table.py: _numbers": "wrong tables: tests/unit/piles/test_groups.py",
    "piles/balls.py: _numbers": "rows of different lengths: tests/unit/piles/test_input.py",
    "piles/march.py: march": "from Python: tests/unit/piles/test_input.py",
    "piles/pile.py: __post_init__": "gravity of a load fits: tests/unit/piles/test_input.py",
    "piles/state.py: writable": "states of other marches, from Python: tests/unit/piles/test_groups.py",
    "meshes/adaptive/adapt.py: __post_init__": "from Python: tests/unit/marching/remeshing/test_adaptive_march.py",
    "marching/remeshing/admitted.py: _require_implicit": "tests/unit/marching/remeshing/test_adaptive_march.py",
    "marching/remeshing/admitted.py: _require_rule": "tests/unit/marching/remeshing/test_other_parts.py",
    "marching/remeshing/admitted.py: _require_cells": "tests/unit/marching/remeshing/test_other_parts.py",
    "marching/remeshing/admitted.py: _require_linked": "tests/unit/marching/remeshing/linked/test_ties.py",
    "model/ties.py: require_even": "from Python: tests/unit/model/test_hanging_nodes.py",
    "marching/remeshing/admitted.py: _require_carried": "tests/unit/marching/remeshing/test_other_parts.py",
    "marching/remeshing/adapted_scene.py: at": "a state of another scene, from Python",
    "marching/remeshing/forming/formed_scene.py: at": "a state of another scene, from Python",
    "marching/remeshing/forming/formable.py: _require_new_cells": NEW_CELLS,
    "marching/remeshing/forming/formable.py: _require_plain": FORGED,
    "marching/remeshing/forming/formable.py: _require_alone": FORGED,
    "marching/remeshing/forming/formable.py: _require_passing": WARM,
    "marching/remeshing/forming/formable.py: _require_heat_of_materials": BIMETALS,
    "meshes/remeshed/remeshed_mesh.py: require_of": "damaged: tests/unit/marching/remeshing/forming/test_continued.py",
    "meshes/remeshed/remesh.py: __post_init__": FORGED,
    "scenario/files.py: load": "millions of characters",
    "scenario/checks/stored_run.py: _require_state": "mechanisms: tests/unit/scenario/mechanisms/test_resumed_runs.py",
    "scenario/run_rigid.py: _require_state": "and of solids: the same",
    "scenario/run.py: stored": "run folders: tests/unit/scenario/runs/test_resume.py",
    "scenario/text/reader.py: _scalar": "a type that no key of a scenario has",
    "solve/linear/pattern.py: require": INNER,
    "solve/operators/multigrid.py: require": "a library that is installed here",
}
"""Functions whose refusals are not all tried here."""
Tried = Mapping[str, tuple[InputError | None, InputError | None]]


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory) -> Tried:
    """First refusal of each case, and what follows its remedy."""
    folder = tmp_path_factory.mktemp("remedies")
    remedy_files.write(folder)
    return {
        name: (refusal(lambda case=case: case.begin(folder)), refusal(lambda case=case: case.go_on(folder)))
        for name, case in CASES.items()
    }


def wrong(case: Try | Call, first: InputError | None, after: InputError | None) -> str:
    """Description of a remedy that does not lead on; empty for one that does."""
    if first is None:
        return "is not refused"
    if not first.remedy or case.remedy not in first.remedy:
        return f"has another remedy: {first}"
    if after is not None and (after.problem == first.problem or not case.then):
        return f"is not mended: {first}\n  then {after}"
    return "" if case.then in str(after or "") else f"has another message after {first}\n  {after}"


def test_a_remedy_that_is_followed_leads_on(tried: Tried) -> None:
    found = {name: wrong(CASES[name], *errors) for name, errors in tried.items()}
    assert not any(found.values()), "\n".join(f"{name} {text}" for name, text in found.items() if text)


def raised(file: Path) -> Iterator[tuple[str, range]]:
    """Function and lines of every refusal with a remedy that a module raises."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for function in (n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)):
        for node in (n for n in ast.walk(function) if isinstance(n, ast.Raise) and n.exc is not None):
            calls = (n for n in ast.walk(node.exc) if isinstance(n, ast.Call) and len(n.args) > 2)
            if any(isinstance(n.func, ast.Name) and n.func.id == "InputError" for n in calls):
                yield function.name, range(node.lineno, (node.end_lineno or node.lineno) + 1)


def test_every_refusal_is_tried_or_has_a_reason(tried: Tried) -> None:
    seen = set().union(*(sites(first) for first, _ in tried.values()))
    package = Path(softway.__file__).parent
    files = [
        *(package / name for name in MODULES),
        *(f for part in PARTS for f in sorted((package / part).rglob("*.py"))),
    ]
    left = {
        f"{name}: {function}": lines.start
        for file in files
        for name in [file.relative_to(package).as_posix()]
        for function, lines in raised(file)
        if not any((name, line) in seen for line in lines)
    }
    assert not (missing := left.keys() - REASONS.keys()), sorted(f"{name}, line {left[name]}" for name in missing)
    assert not (idle := REASONS.keys() - left.keys()), sorted(idle)
