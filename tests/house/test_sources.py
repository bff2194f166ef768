"""House rules of CONTRIBUTING.md about the modules of the package."""

import ast
import re
import sys
import tomllib
from collections.abc import Callable, Iterable
from fnmatch import fnmatch
from pathlib import Path

import pytest

from sources import (
    Documented,
    Source,
    bases,
    classes,
    decorators,
    functions,
    imported,
    is_dataclass,
    length,
    parsed,
    public,
)

MODULE_LINES, FUNCTION_LINES = 300, 40

# Functions that read better as one piece than as several; none may pass HARD_FUNCTION_LINES.
LONG_FUNCTIONS: frozenset[str] = frozenset()
HARD_FUNCTION_LINES = 60

# Where each third-party library may be imported; NumPy and SciPy may be anywhere.
DOORS = {
    "basix": ("softway.meshes.element",),
    "meshio": ("softway.meshes.files.mesh_files",),
    "h5py": ("softway.record.write.grid.grid_series", "softway.record.storage.gate.hdf5_file"),
    "matplotlib": ("softway.record.view.*",),
    "pyvista": ("softway.record.read.frames", "softway.apps.viewer.solids"),
    "imageio_ffmpeg": ("softway.record.view.film",),
    "trame": ("softway.apps.viewer.*",),
    "aiohttp": ("softway.apps.viewer.guard",),
    "pint": ("softway.scenario.hints.units_text",),
    "lazy_loader": ("softway.public_names",),
    "tomli_w": ("softway.scenario.files",),
    "cyclopts": ("softway.apps.cli.*",),
    "rich": ("softway.apps.cli.*",),
    "pypardiso": ("softway.solve.linear.backends.pardiso",),
    "sksparse": ("softway.solve.linear.backends.cholmod",),
    "distributed": ("softway.studies.sweep.cluster",),
    "mumps": ("softway.solve.linear.backends.mumps",),
    "mmgpy": ("softway.adaptivity.new_cells.mmg",),
    "mpi4py": ("softway.ranks.mpi",),
    "warp": ("softway.kernels.device.door",),
    "threadpoolctl": ("softway.solve.linear.blas_threads",),
    "petsc4py": ("softway.ranks.petsc",),
    "mujoco": ("softway.mechanisms.robots.robot_file",),
    "gmsh": (),
    "numba": ("softway.kernels.*",),
    "llvmlite": ("softway.kernels.jit.simd", "softway.kernels.jit.by_address"),
    "numpy": ("*",),
    "scipy": ("*",),
}

# Bases that bring no behaviour of ours: interfaces, errors, records.
PLAIN_BASES = {
    "AttributeTemplate",
    "Protocol",
    "Generic",
    "NamedTuple",
    "Enum",
    "StrEnum",
    "Exception",
    "SoftwayError",
    "Mapping",
    "Sequence",
    "Type",  # of Numba
}

# What a library does so that its log goes nowhere until the program around it says where.
PUBLIC = "__getattr__, __dir__, __all__ = public(__name__, __file__)"
SILENCE = "logging.getLogger(__name__).addHandler(logging.NullHandler())"

Finder = Callable[[Source], Iterable[str]]


def long_modules(source: Source) -> Iterable[str]:
    lines = source.text.count("\n")
    if lines > MODULE_LINES:
        yield f"{lines} lines, at most {MODULE_LINES}"


def long_functions(source: Source) -> Iterable[str]:
    for node in functions(source.tree):
        limit = HARD_FUNCTION_LINES if f"{source.name}.{node.name}" in LONG_FUNCTIONS else FUNCTION_LINES
        if length(node) > limit:
            yield f"{node.name} (line {node.lineno}) has {length(node)} lines, at most {limit}"


def wrong_doors(source: Source) -> Iterable[str]:
    for line, name in imported(source.tree):
        library = name.split(".")[0]
        if any(fnmatch(source.name, door) for door in DOORS.get(library, ())):
            continue
        if library in DOORS:
            yield f"line {line}: {library} enters by {', '.join(DOORS[library]) or 'no module'}"


def relative_imports(source: Source) -> Iterable[str]:
    for line, name in imported(source.tree):
        if name.startswith("."):
            yield f"line {line}: relative import"


def unknown_libraries(source: Source) -> Iterable[str]:
    for line, name in imported(source.tree):
        library = name.split(".")[0]
        if library and library not in DOORS and library != "softway" and library not in sys.stdlib_module_names:
            yield f"line {line}: {library} has no door yet"


def hidden_annotations(source: Source) -> Iterable[str]:
    if any(is_dataclass(c) for c in classes(source.tree)):
        for line, name in imported(source.tree):
            if name == "__future__":
                yield f"line {line}: 'from __future__' beside dataclasses hides their units"


def missing_docstrings(source: Source) -> Iterable[str]:
    if not source.path.name.startswith("__init__") and ast.get_docstring(source.tree) is None:
        yield "module without docstring"
    for name, node in public(source.tree):
        if ast.get_docstring(node) is None and not _is_stub(node):
            yield f"{name} (line {node.lineno}) without docstring"


def _is_stub(node: Documented) -> bool:
    """A line ``...`` of a Protocol: the docstring of the class tells what it asks for."""
    match node.body:
        case [ast.Expr(value=ast.Constant(value=value))]:
            return value is ...
    return False


def mutable_dataclasses(source: Source) -> Iterable[str]:
    for node in classes(source.tree):
        for word, keywords in decorators(node):
            frozen = keywords.get("frozen")
            if word == "dataclass" and not (isinstance(frozen, ast.Constant) and frozen.value is True):
                yield f"{node.name} (line {node.lineno}) is not frozen"


def inherited_behaviour(source: Source) -> Iterable[str]:
    for node in classes(source.tree):
        if extra := bases(node) - PLAIN_BASES:
            yield f"{node.name} (line {node.lineno}) inherits from {', '.join(sorted(extra))}"


def global_state(source: Source) -> Iterable[str]:
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Global):
            yield f"line {node.lineno}: global {', '.join(node.names)}"


def busy_packages(source: Source) -> Iterable[str]:
    if source.path.name == "__init__.py":
        for node in source.tree.body:
            if not _only_exports(node):
                yield f"line {node.lineno}: an __init__ only exports"


def _only_exports(node: ast.stmt) -> bool:
    match node:
        case ast.Import() | ast.ImportFrom():
            return True
        case ast.Expr(value=ast.Constant(value=str())):
            return True
        case ast.Assign(targets=[ast.Name(id="__all__" | "__version__")]):
            return True
        case ast.If(test=ast.UnaryOp(op=ast.Not(), operand=ast.Name(id="TYPE_CHECKING")), body=body, orelse=[]):
            return all(_only_exports(inner) for inner in body)
    return ast.unparse(node) in (PUBLIC, SILENCE)


def unlisted_exports(source: Source) -> Iterable[str]:
    """Names of ``__all__`` that the package does not import."""
    if source.path.name != "__init__.py":
        return
    names = {
        a.asname or a.name for n in ast.walk(source.tree) if isinstance(n, ast.ImportFrom | ast.Import) for a in n.names
    }
    assigned = {
        t.id for n in source.tree.body if isinstance(n, ast.Assign) for t in n.targets if isinstance(t, ast.Name)
    }
    for node in source.tree.body:
        if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == "__all__" for t in node.targets):
            yield from (
                f"'{n}' is exported but not imported" for n in ast.literal_eval(node.value) if n not in names | assigned
            )


def prints(source: Source) -> Iterable[str]:
    if fnmatch(source.name, "softway.apps.cli*"):
        return
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print":
            yield f"line {node.lineno}: print"


REDUCTIONS = {"max", "min", "sum", "any", "all", "vdot", "norm"}
NODAL = re.compile(r"\b(displacement|velocity|acceleration|massive|mass|free|points|residual|moving|q|step|u0|u1)\b")
ROWS = re.compile(r"\.(active|near)\b")
BY_SOLID = {"model.kinetic(before.start.velocity).sum()", "model.energy_and_force(rest.displacement)[0].sum()"}


def nodal_reductions(source: Source) -> Iterable[str]:
    """Sums and greatest values over nodes or unknowns beside ``VectorSpace``, in the slab and the march."""
    if not source.name.startswith(("softway.marching", "softway.solve.equations", "softway.solve.methods")):
        return
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in REDUCTIONS:
            of, text = ast.unparse(node.func.value), ast.unparse(node)
            rowwise = any(k.arg == "axis" and ast.unparse(k.value) != "0" for k in node.keywords)
            nodal = NODAL.search(text) and not ROWS.search(text)
            if not rowwise and "space" not in of and text not in BY_SOLID and nodal:
                yield f"line {node.lineno}: {text}"


RULES: tuple[Finder, ...] = (
    long_modules,
    long_functions,
    wrong_doors,
    unknown_libraries,
    relative_imports,
    hidden_annotations,
    missing_docstrings,
    mutable_dataclasses,
    inherited_behaviour,
    global_state,
    busy_packages,
    unlisted_exports,
    prints,
    nodal_reductions,
)


@pytest.mark.parametrize("rule", RULES, ids=lambda r: r.__name__)
def test_house_rule(rule: Finder, sources: tuple[Source, ...]) -> None:
    found = [f"{s.name}: {what}" for s in sources for what in rule(s)]
    assert not found, "\n".join(found)


def test_every_dependency_is_imported(root: Path, sources: tuple[Source, ...]) -> None:
    wanted = tomllib.loads((root / "pyproject.toml").read_text())["project"]["dependencies"]
    modules = {"fenics-basix": "basix", "lazy-loader": "lazy_loader", "tomli-w": "tomli_w"}
    names = {re.split(r"[<>=~! ]", d)[0] for d in wanted}
    used = {name.split(".")[0] for s in sources for _, name in imported(s.tree)}
    assert {modules.get(n, n) for n in names} <= used


def test_the_package_was_found(sources: tuple[Source, ...]) -> None:
    assert any(s.name == "softway.model.scene" for s in sources)


BAD = """
from __future__ import annotations
import rich, unheard_of
from dataclasses import dataclass
from . import sibling
@dataclass
class Thing(Base):
    x: int
    def act(self):
        global state
        print("x")
"""


@pytest.mark.parametrize(
    "rule",
    [
        wrong_doors,
        unknown_libraries,
        relative_imports,
        hidden_annotations,
        missing_docstrings,
        mutable_dataclasses,
        inherited_behaviour,
        global_state,
        prints,
    ],
    ids=lambda r: r.__name__,
)
def test_a_rule_finds_what_it_forbids(rule: Finder, tmp_path) -> None:
    path = tmp_path / "bad.py"
    path.write_text(BAD)
    assert list(rule(parsed(path, tmp_path)))
