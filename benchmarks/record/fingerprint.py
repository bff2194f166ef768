"""What a figure was measured of: date, commit, and fingerprints of the code that decides it and of what measures it.

A fingerprint is that of the syntax trees: comments, docstrings, the layout of lines and quotes change nothing.
"""

import ast
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from hashlib import sha256
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MARCH = tuple(
    f"src/softway/{part}"
    for part in (
        "bodies", "contact", "kernels", "laws", "marching", "meshes", "model", "obstacles", "solve",
    )
)  # fmt: skip
CELLS = tuple(f"src/softway/{part}" for part in ("bodies", "kernels", "laws", "meshes"))
PILES = ("src/softway/kernels/jit", "src/softway/kernels/pile", "src/softway/piles")
CODE = {
    "adapted": (*MARCH, "src/softway/adaptivity"),
    "heated": (*MARCH, "src/softway/heat"),
    "kernels": CELLS,
    "history": CELLS,
    "pile": PILES,
    "small": (*MARCH, "src/softway/record", "src/softway/scenario"),
}
"""What is measured, by group; the slab and all that it is made of where nothing is said."""
THROWN = (
    "benchmarks/groups/cube.py",
    "benchmarks/groups/peers.py",
    "benchmarks/peers",
    "src/softway/apps/verify/scenes/cube.py",
)
PARTS, METHODS = "benchmarks/groups/parts.py", "benchmarks/groups/methods.py"
BLOCKS = "benchmarks/groups/blocks.py"
RATES = (
    "benchmarks/groups/rates.py",
    "benchmarks/processes/large/contact_counts.py",
    "benchmarks/processes/large/contact_rates.py",
    "benchmarks/groups/peers.py",
    "benchmarks/peers",
)
BENCHES = {
    "start": (METHODS,),
    "drop": THROWN,
    "accuracy": (*THROWN, "benchmarks/groups/accuracy.py", "benchmarks/groups/force.py"),
    "threads": THROWN[::3],
    "explicit": THROWN,
    "newton": (METHODS,),
    "incompressible": (METHODS,),
    "kernels": (PARTS, "benchmarks/parts/bench_kernels.py", "benchmarks/parts/fused.cpp"),
    "history": (PARTS, "benchmarks/parts/bench_history.py"),
    "factor": (PARTS, "benchmarks/parts/bench_factor.py"),
    "contact": (PARTS, "benchmarks/parts/bench_contact.py"),
    "unmet": (BLOCKS, "benchmarks/parts/bench_open_contact.py"),
    "rates": RATES,
    "dense": RATES[:3],
    "pressed": (BLOCKS, "benchmarks/parts/bench_two_bodies.py"),
    "blocks": (
        BLOCKS,
        "benchmarks/groups/force.py",
        "benchmarks/groups/peers.py",
        "benchmarks/peers",
        "benchmarks/processes/collision.py",
    ),  # fmt: skip
    "slab": (PARTS, "benchmarks/parts/bench_slab.py"),
    "small": (PARTS, "benchmarks/processes/small_problems.py"),
    "adapted": (
        "benchmarks/groups/adapted.py",
        "benchmarks/processes/adapted.py",
        "benchmarks/processes/bracket.py",
    ),
    "heated": ("benchmarks/groups/heated.py", "benchmarks/processes/heated.py"),
    "pile": ("benchmarks/groups/piles.py", "benchmarks/parts/bench_pile.py"),
    "large": THROWN[::3],
}
"""What measures it, by group."""
COMMON = ("benchmarks/processes/alone.py", "benchmarks/processes/problems.py", "benchmarks/processes/apart.py")
"""What measures every group."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """Where the figures of a group come from.

    Parameters
    ----------
    date
        Day on which they were measured.
    commit
        Commit that was checked out, with ``, changed`` where it had been edited since.
    code
        Fingerprint of what was measured.
    bench
        Fingerprint of what measured it.
    seconds
        How long the group took [s].
    """

    date: str
    commit: str
    code: str
    bench: str
    seconds: float = 0.0


def origin(group: str, seconds: float, root: Path = ROOT) -> Origin:
    """The origin of figures that are measured now."""
    code, bench = prints(group, root)
    return Origin(date=f"{datetime.now(UTC):%Y-%m-%d}", commit=commit(root), code=code, bench=bench, seconds=seconds)


def prints(group: str, root: Path = ROOT) -> tuple[str, str]:
    """Fingerprints of what a group measures, and of what measures it, as they are now."""
    return fingerprint(CODE.get(group, MARCH), root), fingerprint((*BENCHES[group], *COMMON), root)


def fingerprint(places: Iterable[str], root: Path = ROOT) -> str:
    """Fingerprint of files and of all sources in folders."""
    total = sha256()
    for file in sorted({file for place in places for file in _files(root / place)}):
        total.update(file.relative_to(root).as_posix().encode())
        text = file.read_text(encoding="utf-8")
        total.update((_parsed(text) if file.suffix == ".py" else text).encode())
    return total.hexdigest()[:16]


def commit(root: Path = ROOT) -> str:
    """The commit that is checked out; ``unknown`` outside of a repository."""
    try:
        head = _git(root, "rev-parse", "--short=12", "HEAD").strip()
        return head + ", changed" * bool(_git(root, "status", "--porcelain", "--", "src", "benchmarks/*.py").strip())
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def _git(root: Path, *words: str) -> str:
    return subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=True).stdout


def _files(place: Path) -> Iterator[Path]:
    if place.is_dir():
        yield from place.rglob("*.py")
    else:
        yield place


@cache
def _parsed(text: str) -> str:
    return sha256(_plain(ast.parse(text)).encode()).hexdigest()


def _plain(node: object) -> str:
    """A syntax tree as text, the same with every version of Python: no empty fields, no places, no bare strings."""
    if isinstance(node, ast.AST):
        fields = ((k, v) for k, v in ast.iter_fields(node) if k not in ("ctx", "kind", "type_comment"))
        return f"{type(node).__name__}({','.join(f'{k}={_plain(v)}' for k, v in fields if v is not None and v != [])})"
    if isinstance(node, list):
        return f"[{','.join(_plain(n) for n in node if not _bare(n))}]"
    return repr(node)


def _bare(node: object) -> bool:
    """Whether a statement is only a string: a docstring, or words under a constant."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
