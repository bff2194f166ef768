"""The quick tests with the instructions of several processors: libraries round otherwise with each.

    python tests/robustness/processors.py [SET ...] [--jobs 2] [--out FILE.json]

OpenBLAS, MKL and Numba choose their code by the processor; environment variables make them take that of an older one.
A set whose instructions this processor lacks is skipped, and said to be.  With ``--out`` the results of the sets that
ran are kept there, and the page beside its folder is written.
"""

import argparse
import datetime
import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from page import table

ROOT = Path(__file__).parents[2]
LEFT = (
    "benchmarks",
    "contracts",
    "examples",
    "house",
    "paper",
    "robustness",
    "scenarios/test_notes.py",
    "unit/adaptivity/test_hanging_heat.py",
    "unit/adaptivity/test_heat.py",
    "unit/adaptivity/test_memory.py",
    "unit/adaptivity/test_projection.py",
    "unit/adaptivity/test_transfer.py",
    "unit/adaptivity/unrelated/test_heat_transfer.py",
    "unit/adaptivity/unrelated/test_hexahedra.py",
    "unit/apps",
    "unit/bodies",
    "unit/cluster",
    "unit/contact/assembly",
    "unit/contact/mortar/test_curved_facets.py",
    "unit/contact/mortar/test_curved_surface.py",
    "unit/contact/mortar/test_dual_basis.py",
    "unit/contact/node_to_surface/test_node_to_facet.py",
    "unit/contact/surfaces/test_boundary.py",
    "unit/contact/surfaces/test_facet_geometry.py",
    "unit/contact/surfaces/test_nodal_tractions.py",
    "unit/contact/surfaces/test_sagitta.py",
    "unit/heat/coupling/test_dissipation.py",
    "unit/heat/coupling/test_expansion.py",
    "unit/heat/coupling/test_quadratic_cells.py",
    "unit/heat/coupling/test_rigid_bodies.py",
    "unit/heat/coupling/test_softening.py",
    "unit/heat/coupling/test_stiffness.py",
    "unit/heat/coupling/test_stiffness_history.py",
    "unit/heat/test_balances.py",
    "unit/heat/test_brake.py",
    "unit/heat/test_conduction.py",
    "unit/heat/test_held_temperatures.py",
    "unit/heat/test_regions.py",
    "unit/kernels",
    "unit/laws",
    "unit/marching/audit",
    "unit/marching/friction/test_impulse_laws.py",
    "unit/marching/motion/test_damped_bodies.py",
    "unit/marching/motion/test_free_bodies.py",
    "unit/marching/motion/test_load_ramps.py",
    "unit/marching/motion/test_path_dependent_laws.py",
    "unit/marching/motion/test_slab_ladder.py",
    "unit/marching/remeshing/carried",
    "unit/marching/remeshing/forming/materials",
    "unit/marching/remeshing/forming/test_continued.py",
    "unit/marching/remeshing/forming/test_energy.py",
    "unit/marching/remeshing/forming/warm",
    "unit/marching/remeshing/linked",
    "unit/marching/remeshing/test_continued.py",
    "unit/marching/remeshing/test_other_parts.py",
    "unit/marching/rules/test_central_difference.py",
    "unit/marching/start/test_initial_state.py",
    "unit/marching/start/test_knots.py",
    "unit/marching/start/test_slab_length.py",
    "unit/marching/state",
    "unit/mechanisms/test_couplings.py",
    "unit/mechanisms/test_forces.py",
    "unit/mechanisms/test_geometry.py",
    "unit/mechanisms/test_joints.py",
    "unit/mechanisms/test_march.py",
    "unit/mechanisms/test_march_state.py",
    "unit/mechanisms/test_motors.py",
    "unit/mechanisms/test_robot_files.py",
    "unit/meshes",
    "unit/model",
    "unit/obstacles",
    "unit/piles",
    "unit/ranks",
    "unit/record",
    "unit/scenario",
    "unit/solve/device",
    "unit/solve/equations",
    "unit/solve/linear",
    "unit/solve/methods/test_power_law_flow.py",
    "unit/solve/operators",
    "unit/studies",
    "unit/testing",
    "verification/contact/test_b03_cylinder_on_plane.py",
    "verification/contact/test_b04_hemisphere_on_plane.py",
    "verification/contact/test_b05_ball_impact.py",
    "verification/contact/test_b06_press_fit.py",
    "verification/contact/test_b07_cattaneo_mindlin.py",
    "verification/contact/test_b07_normal_load.py",
    "verification/elements",
    "verification/exact",
    "verification/forming",
    "verification/large_deformation",
    "verification/mechanisms",
    "verification/test_cases.py",
    "verification/test_catalogue.py",
    "verification/tools",
    "verification/waves",
)
"""Tests that decide nothing by numbers that may be rounded either way: they read, refuse, write and show, compute
forces and laws in closed form, motions without contact, or one march twice; balls of piles are swept until they
converge.  Heat that flows, fields on a new mesh and sums over cells are linear; fronts and contacts of heat stay in.

Others decide as tests that stay in: the single bars of the paper and of the waves meet their walls in
``unit/marching/impacts``; bodies of the contact cases touch in ``unit/contact`` and ``unit/marching``, patches (B01)
and the disc on a wall (B08) stay in; remeshed forming decides in ``test_forming_march.py`` and ``test_new_cells.py``.
"""
QUICK = (
    "-q",
    "--dist",
    "loadscope",
    "-m",
    "not slow and not minutes",
    *(f"--ignore=tests/{place}" for place in LEFT),
)
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
AVX2 = frozenset({"avx2", "fma"})
AVX512 = frozenset({"avx512f", "avx512dq", "avx512bw", "avx512vl", "avx512cd"})


@dataclass(frozen=True, slots=True, kw_only=True)
class Instructions:
    """What the libraries are told: code of OpenBLAS, instructions of MKL, processor of Numba (None for this one),
    threads; and the ``flags`` that the processor must have.
    """

    openblas: str
    mkl: str
    numba: str | None
    threads: int
    flags: frozenset[str]

    def environment(self, given: Mapping[str, str]) -> dict[str, str]:
        """The environment of the tests.

        Examples
        --------
        >>> SETS["nehalem"].environment({"LANG": "C"})["OPENBLAS_CORETYPE"]
        'Nehalem'
        """
        out = {name: value for name, value in given.items() if name != "NUMBA_CPU_NAME"}
        out |= {"OPENBLAS_CORETYPE": self.openblas, "MKL_ENABLE_INSTRUCTIONS": self.mkl, "MPLBACKEND": "Agg"}
        out |= dict.fromkeys(THREADS, str(self.threads))
        return out if self.numba is None else out | {"NUMBA_CPU_NAME": self.numba}


SETS = {
    "nehalem": Instructions(openblas="Nehalem", mkl="SSE4_2", numba="generic", threads=1, flags=frozenset({"sse4_2"})),
    "haswell": Instructions(openblas="Haswell", mkl="AVX2", numba=None, threads=1, flags=AVX2),
    "zen": Instructions(openblas="Zen", mkl="AVX2", numba=None, threads=2, flags=AVX2),
    "skylakex": Instructions(openblas="SkylakeX", mkl="AVX512", numba=None, threads=2, flags=AVX2 | AVX512),
}
"""Every value of each library is in one of them."""

HEAD = """# Processors

`make test-processors` makes this page: the tests of `make test` that decide by numbers, with the instructions of
several processors. The last digits of sums and products differ with the code that OpenBLAS, MKL and Numba take for a
processor, and with the number of threads; no result may hang on them. `make test-processors SETS=nehalem` runs one set.
A set is skipped where the processor lacks its instructions.

"""


def flags(info: Path = Path("/proc/cpuinfo")) -> frozenset[str]:
    """Instructions that this processor has; none where the system does not tell."""
    lines = info.read_text(encoding="utf-8").splitlines() if info.is_file() else []
    return frozenset(word for line in lines if line.startswith("flags") for word in line.partition(":")[2].split())


def counted(told: str) -> dict[str, int]:
    """Numbers of tests from the last line of pytest.

    Examples
    --------
    >>> counted("== 7 failed, 5205 passed, 17 skipped in 481.72s (0:08:01) ==")
    {'passed': 5205, 'failed': 7, 'skipped': 17}
    >>> counted("== 2 passed, 1 error in 1.00s ==")
    {'passed': 2, 'failed': 1, 'skipped': 0}
    """
    found = {word: int(number) for number, word in re.findall(r"(\d+) (passed|failed|skipped|error)", told)}
    failed = found.get("failed", 0) + found.get("error", 0)
    return {"passed": found.get("passed", 0), "failed": failed, "skipped": found.get("skipped", 0)}


def examined(it: Instructions, jobs: int, more: Sequence[str]) -> dict[str, Any]:
    """The quick tests with a set, told as they go: how many passed, failed and were skipped, and which failed."""
    command = [sys.executable, "-m", "pytest", "-n", str(jobs), *QUICK, *(more or ["tests"])]
    lines = []
    with subprocess.Popen(
        command, cwd=ROOT, env=it.environment(os.environ), stdout=subprocess.PIPE, text=True, encoding="utf-8"
    ) as process:
        assert process.stdout is not None
        for line in process.stdout:
            print(line, end="", flush=True)
            lines.append(line)
    found = counted(lines[-1] if lines else "")
    names = [line.split()[1] for line in lines if line.startswith(("FAILED ", "ERROR "))]
    if process.returncode and not found["failed"]:
        found["failed"], names = 1, [*names, f"pytest ends with {process.returncode}"]
    return {**found, "names": names, "on": str(datetime.date.today())}


def page(found: Mapping[str, Mapping[str, Any]]) -> str:
    """The page of the results of the sets.

    Examples
    --------
    >>> text = page({"nehalem": {"passed": 3, "failed": 1, "skipped": 0, "names": ["test_a.py::test_b"]}})
    >>> print(text.splitlines()[-1])
    Failed with nehalem: `test_a.py::test_b`.
    """
    head = ["set", "OpenBLAS", "MKL", "Numba", "threads", "passed", "failed", "skipped", "day"]
    rows, failed = [], []
    for name, it in SETS.items():
        told = found.get(name)
        mine = (
            ["not run", "", "", ""]
            if told is None
            else [told.get(k, "") for k in ("passed", "failed", "skipped", "on")]
        )
        if told is not None:
            failed += [f"Failed with {name}: `{test}`." for test in told["names"]]
        rows.append([name, it.openblas, it.mkl, it.numba or "this processor", it.threads, *mine])
    return HEAD + table(head, rows) + ("\n" + "\n".join(failed) + "\n" if failed else "")


def main() -> int:
    """Run the sets."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("sets", nargs="*", metavar="SET", help=f"of {', '.join(SETS)}; by default all of them")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--only", nargs="+", default=[], metavar="TEST", help="tests in place of all that are quick")
    asked = parser.parse_args()
    unknown = sorted(set(asked.sets) - SETS.keys())
    if unknown:
        parser.error(f"no set {', '.join(unknown)}: there are {', '.join(SETS)}")
    kept = json.loads(asked.out.read_text()) if asked.out is not None and asked.out.is_file() else {}
    told, here = {}, flags()
    for name in asked.sets or SETS:
        lacking = sorted(SETS[name].flags - here)
        if lacking:
            print(f"set {name} is skipped: this processor lacks {', '.join(lacking)}", flush=True)
            continue
        print(f"set {name}", flush=True)
        told[name] = examined(SETS[name], asked.jobs, asked.only)
        if asked.out is not None:
            asked.out.write_text(json.dumps(kept | told, indent=1) + "\n", encoding="utf-8")
            asked.out.parent.with_name("processors.md").write_text(page(kept | told), encoding="utf-8")
    for name, found in told.items():
        print(f"{name}: {found['passed']} passed, {found['failed']} failed, {found['skipped']} skipped")
    return int(any(found["failed"] for found in told.values()))


if __name__ == "__main__":
    sys.exit(main())
