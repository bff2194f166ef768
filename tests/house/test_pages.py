"""What the pages name is there: modules, what is in them, options of classes, links to files and to headings."""

import ast
import re
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

import softway as sw

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(p for p in ROOT.glob("docs/**/*.md") if "_build" not in p.parts)])
PLACES = (ROOT / "src" / "softway", ROOT / "src", ROOT)
OWN = {"own_law.md"}
"""Pages whose files the reader writes."""
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
MODULE = re.compile(r"`((?:[\w.]+/)*\w+\.py)(?:(?:: |`: `)(\w+(?:\.\w+)*))?`")
DOTTED = re.compile(r"`(softway(?:\.\w+)+)`")
CALL = re.compile(r"`([A-Z]\w+)\((\w+)=[^`]*\)`")
LINK = re.compile(r"\]\(([^)#\s:]*)(?:#([^)\s]+))?\)")
HEADING = re.compile(r"^#+ +(.+)$", re.MULTILINE)


def named(pattern: re.Pattern[str]) -> list[tuple[Path, tuple[str, ...]]]:
    """What the pages say that looks like this, outside of their blocks of code."""
    return [(page, found.groups()) for page in PAGES for found in pattern.finditer(FENCE.sub("", text(page)))]


@cache
def text(page: Path) -> str:
    return page.read_text(encoding="utf-8")


@cache
def found(path: str) -> tuple[Path, ...]:
    """The files that a page may mean: below the package or the checkout, or a lone name anywhere in them."""
    files = [place / path for place in PLACES if (place / path).is_file()]
    if not files and "/" not in path:
        files = [
            p for folder in ("src", "tests", "docs", "benchmarks", "examples") for p in ROOT.glob(f"{folder}/**/{path}")
        ]
    return tuple(files)


@cache
def names(file: Path) -> frozenset[str]:
    """Names that a module defines, with members of its classes as ``Class.member``."""
    out = set()
    for node in ast.parse(text(file)).body:
        here = _defined(node)
        out |= here
        if isinstance(node, ast.ClassDef):
            out |= {f"{node.name}.{name}" for inner in node.body for name in _defined(inner)}
    return frozenset(out)


def _defined(node: ast.stmt) -> set[str]:
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return {name}
        case ast.AnnAssign(target=ast.Name(id=name)):
            return {name}
        case ast.Assign(targets=targets):
            return {t.id for t in targets if isinstance(t, ast.Name)}
        case _:
            return set()


def test_modules_are_there_and_have_what_is_named() -> None:
    wrong = [
        f"{page.relative_to(ROOT)}: {path}{': ' + name if name else ''}"
        for page, (path, name) in named(MODULE)
        if page.name not in OWN and not any(not name or name in names(file) for file in found(path))
    ]
    assert not wrong, "\n".join(wrong)


def test_dotted_names_are_there() -> None:
    wrong = [f"{page.relative_to(ROOT)}: {name}" for page, (name,) in named(DOTTED) if not _imports(name)]
    assert not wrong, "\n".join(wrong)


def _imports(name: str) -> bool:
    module, _, last = name.rpartition(".")
    try:
        return bool(import_module(name))
    except ImportError:
        pass
    try:
        return hasattr(import_module(module), last)
    except ImportError:
        return False


def public(name: str) -> object:
    """The class of a public name, in the package or in one of those that it exports."""
    packages = (sw, *(value for value in vars(sw).values() if getattr(value, "__all__", None)))
    return next((vars(found)[name] for found in packages if name in vars(found)), None)


def test_options_are_those_of_their_classes() -> None:
    wrong = []
    for page, (name, option) in named(CALL):
        thing = public(name)
        if thing is None or option not in getattr(thing, "__dataclass_fields__", {}):
            wrong.append(f"{page.relative_to(ROOT)}: {name}({option}=...)")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    wrong = []
    for target, anchor in LINK.findall(FENCE.sub("", text(page))):
        file = (page.parent / target).resolve() if target else page
        if not file.exists():
            wrong.append(target)
        elif anchor and file.suffix == ".md" and anchor not in anchors(file):
            wrong.append(f"{target}#{anchor}")
    assert not wrong


@cache
def anchors(page: Path) -> frozenset[str]:
    """Anchors of the headings of a page, as they are made from their words."""
    heads = (re.sub(r"[`*]|\[([^]]*)\]\([^)]*\)", r"\1", h) for h in HEADING.findall(FENCE.sub("", text(page))))
    return frozenset(re.sub(r"[^\w\- ]", "", head.strip().lower()).replace(" ", "-") for head in heads)


def test_enough_is_looked_at() -> None:
    assert len(named(MODULE)) > 100 and len(named(CALL)) > 10 and len(named(LINK)) > 100
