"""Folders stay small, they do not depend on each other in circles, and no module hides one of Python's."""

import ast
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

from sources import Source, read_sources

ENTRIES = 12
"""Greatest number of modules, pages and folders in a folder."""
TOPS = ("src", "tests", "docs", "benchmarks", "examples")
LISTS = {"src/softway", "tests/unit"}
"""Folders that list the layers of the package."""
MADE = {"docs/_build", "docs/examples"}
"""Folders that ``make docs`` writes."""
WRITTEN = {".py", ".md"}
"""Modules and pages; folders without any hold data, pictures for example, named after what they belong to."""


def entries(root: Path, folder: Path) -> list[str]:
    """Modules, pages, folders and data of a folder, without what Python, its tools and make put there."""
    names = (p.name for p in folder.iterdir() if p.relative_to(root).as_posix() not in MADE)
    return sorted(n for n in names if not n.startswith((".", "__")) and n not in ("conftest.py", "py.typed"))


def crowded(root: Path, top: str) -> Iterator[str]:
    """Folders below ``top`` with too many entries."""
    for folder in (root / top, *(p for p in (root / top).rglob("*") if p.is_dir())):
        name = folder.relative_to(root).as_posix()
        hidden = any(part.startswith(("__", ".")) for part in folder.relative_to(root).parts)
        made = any(name == place or name.startswith(f"{place}/") for place in MADE)
        data = not any(p.suffix in WRITTEN for p in folder.rglob("*"))
        if not (hidden or made or data) and name not in LISTS and len(entries(root, folder)) > ENTRIES:
            yield f"{name}: {len(entries(root, folder))} entries, at most {ENTRIES}"


def shadowing(root: Path) -> Iterator[str]:
    """Modules of the package with the name of a module of Python."""
    for path in (root / "src").rglob("*"):
        if (path.suffix == ".py" or path.is_dir()) and path.stem in sys.stdlib_module_names:
            yield path.relative_to(root).as_posix()


def circles(sources: tuple[Source, ...]) -> Iterator[str]:
    """Neighbours in a folder, modules or folders, that import each other in a circle, at any depth."""
    for folder, imports in neighbours(sources).items():
        done: set[str] = set()
        for name in list(imports):
            yield from (f"{folder}: {' > '.join(way)}" for way in _ways_back(name, [name], imports, done))


def neighbours(sources: tuple[Source, ...]) -> Mapping[str, Mapping[str, set[str]]]:
    """Names in each folder that a name there imports from."""
    names = {source.name for source in sources}
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for source in sources:
        for node in (n for n in ast.walk(source.tree) if isinstance(n, ast.ImportFrom) and n.module):
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                one, other = source.name.split("."), (full if full in names else str(node.module)).split(".")
                depth = next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), None)
                if depth:
                    found[".".join(one[:depth])][one[depth]].add(other[depth])
    return found


def _ways_back(name: str, way: list[str], imports: Mapping[str, set[str]], done: set[str]) -> Iterator[list[str]]:
    """Ways from a name back to one that is on the way already."""
    if name in done:
        return
    for other in sorted(imports.get(name, ())):
        if other in way:
            yield [*way[way.index(other) :], other]
        else:
            yield from _ways_back(other, [*way, other], imports, done)
    done.add(name)


def test_nothing_is_imported_in_circles(sources: tuple[Source, ...]) -> None:
    assert not (wrong := list(circles(sources))), "\n".join(wrong)


def test_no_folder_is_crowded(root: Path) -> None:
    assert not (wrong := [line for top in TOPS for line in crowded(root, top)]), "\n".join(wrong)


def test_no_module_hides_one_of_python(root: Path) -> None:
    assert not (wrong := list(shadowing(root))), "\n".join(wrong)


def test_the_rules_find_what_they_forbid(tmp_path: Path) -> None:
    folder = tmp_path / "src" / "package"
    folder.mkdir(parents=True)
    for number in range(ENTRIES + 1):
        (folder / f"m{number}.py").touch()
    (folder / "time.py").touch()
    assert list(crowded(tmp_path, "src")) == [f"src/package: {ENTRIES + 2} entries, at most {ENTRIES}"]
    assert list(shadowing(tmp_path)) == ["src/package/time.py"]


def test_pages_count_and_pictures_do_not(tmp_path: Path) -> None:
    for name, suffix in {"theory": "md", "pictures": "png", "examples/contact": "md"}.items():
        folder = tmp_path / "docs" / name
        folder.mkdir(parents=True)
        for number in range(ENTRIES + 1):
            (folder / f"p{number}.{suffix}").touch()
    assert list(crowded(tmp_path, "docs")) == [f"docs/theory: {ENTRIES + 1} entries, at most {ENTRIES}"]


def test_circles_are_found(tmp_path: Path) -> None:
    for name, text in {"a/x": "from b.y import z", "b/y": "from a.x import w", "b/z": "from b.y import u"}.items():
        (tmp_path / "p" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "p" / f"{name}.py").write_text(text.replace("from ", "from p."))
    assert list(circles(read_sources(tmp_path))) == ["p: a > b > a"]
