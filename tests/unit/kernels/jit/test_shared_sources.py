"""Cached kernels: their name has a digest of every source of ours whose code or constants they contain."""

import ast
from pathlib import Path

import pytest

import softway
from softway.kernels.jit import compilation

PACKAGE = Path(softway.__file__).parent
CACHED = {"kernel", "uncounted_kernel", "unfused_kernel", "stage", "function_at", "uncounted_function_at"}
"""Decorators whose machine code is kept on disk."""


def imported(source: Path) -> set[Path]:
    """Sources of ours from which a source imports."""
    found = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        files = [PACKAGE.parent.joinpath(*name.split(".")).with_suffix(".py") for name in names]
        found |= {file for file in files if file.is_file() and file.is_relative_to(PACKAGE)}
    return found


def all_imported(source: Path) -> set[Path]:
    """Sources of ours from which a source imports, also through others; not the source itself, which Numba watches."""
    found, left = {source}, [source]
    while left:
        new = imported(left.pop()) - found
        found |= new
        left += new
    return found - {source}


def makers() -> list[Path]:
    """Sources that keep machine code on disk."""
    door, found = "softway.kernels.jit.compilation", []
    for source in sorted(PACKAGE.rglob("*.py")):
        nodes = ast.walk(ast.parse(source.read_text(encoding="utf-8")))
        names = {a.name for n in nodes if isinstance(n, ast.ImportFrom) and n.module == door for a in n.names}
        found += [source] if names & CACHED else []
    return found


def test_every_way_to_the_disk_is_known() -> None:
    """The decorators above are all functions of the module that keep code on disk."""
    tree = ast.parse(Path(compilation.__file__).read_text(encoding="utf-8"))
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    keep = {
        name
        for name, node in functions.items()
        if any(isinstance(n, ast.Name) and n.id == "_kept" for n in ast.walk(node))
    }
    assert keep == CACHED


@pytest.mark.parametrize("source", makers(), ids=lambda source: str(source.relative_to(PACKAGE)))
def test_the_digest_of_a_kernel_covers_what_it_imports(source: Path) -> None:
    """An edit of any of them gives the kernel another name, so that no machine code of the old source is loaded."""
    shared = {(PACKAGE / "kernels" / name).resolve() for name in compilation._SHARED}
    assert sorted(str(file.relative_to(PACKAGE)) for file in all_imported(source) - shared) == []


def test_the_digest_covers_the_named_tuples_of_kernels() -> None:
    """Kernels receive them as arguments; the type of a tuple does not tell the order of entries of one kind."""
    tables = {
        str(source.relative_to(PACKAGE / "kernels"))
        for source in (PACKAGE / "kernels").rglob("*.py")
        if "(NamedTuple)" in source.read_text(encoding="utf-8") and source.parent.name != "device"
    }
    assert "rigid_contact/tables.py" in tables
    assert sorted(tables - set(compilation._SHARED)) == []


def test_shared_sources_are_named_once_and_in_order() -> None:
    names = list(compilation._SHARED)
    assert names == sorted(set(names))
