"""One word, one definition: the glossary has few terms in order, and the classes that it names have no namesakes."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from sources import Source, classes, read_sources

PAGE = "docs/reference/glossary.md"
TERMS = 60
"""Greatest number of terms."""
ROW = re.compile(r"^\| (?P<term>.+?) \| (?P<meaning>.+) \| (?P<places>`.+`) \|$", re.MULTILINE)
PLACE = re.compile(r"`((?:\w+/)*\w+\.py): (\w+(?:\.\w+)?)`")
NAMESAKES: Mapping[str, frozenset[str]] = {
    "Event": frozenset({"apps/verify/exact/semidiscrete.py", "apps/verify/scenes/bars.py"}),
    "Probe": frozenset({"record/write/probes.py"}),
}
"""Modules that may have a class with the name of one in the glossary: the references of the verification cases, which
share nothing with what they verify, and the interface of a class of the layer above."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A term with its meaning, and the modules and names where it lives."""

    word: str
    meaning: str
    places: tuple[tuple[str, str], ...]


def terms(text: str) -> tuple[Term, ...]:
    """The terms of a page in its order."""
    return tuple(
        Term(word=row["term"], meaning=row["meaning"], places=tuple(PLACE.findall(row["places"])))
        for row in ROW.finditer(text)
    )


def order(word: str) -> str:
    """Key of the alphabetical order."""
    return word.casefold()


def path_of(source: Source) -> str:
    """Path of a module below the package."""
    return source.path.as_posix().rpartition("/softway/")[2]


def defined(tree: ast.AST) -> Iterator[str]:
    """Names that a module or class defines, with the members of classes as ``Class.member``."""
    for node in getattr(tree, "body", ()):
        if isinstance(node, ast.ClassDef):
            yield from (f"{node.name}.{name}" for name in defined(node))
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (target.id for target in targets if isinstance(target, ast.Name))


def malformed(found: Iterable[Term]) -> Iterator[str]:
    """Terms out of order or given twice, without one sentence, or without a place."""
    before = ""
    for term in found:
        if order(term.word) <= order(before):
            yield f"{term.word} after {before}"
        if not term.meaning.endswith(".") or re.search(r"\. [A-Z]", term.meaning):
            yield f"{term.word}: not one sentence"
        if not term.places:
            yield f"{term.word}: no `module.py: name`"
        before = term.word


def lost(found: Iterable[Term], sources: Iterable[Source]) -> Iterator[str]:
    """Places of the glossary that are not in the package."""
    there = {path_of(source): set(defined(source.tree)) for source in sources}
    for term in found:
        for path, name in term.places:
            if name not in there.get(path, ()):
                yield f"{term.word}: {path}: {name}"


def namesakes(found: Iterable[Term], sources: Iterable[Source]) -> Mapping[str, set[str]]:
    """Other modules that define a class with the name of one in the glossary, by name."""
    homes = defaultdict(list)
    for source in sources:
        for node in classes(source.tree):
            homes[node.name].append(path_of(source))
    named = {(path, name) for term in found for path, name in term.places if name in homes}
    others = {name: {home for home in homes[name] if home != path} for path, name in named}
    return {name: places for name, places in others.items() if places}


@pytest.fixture(scope="module")
def glossary(root: Path) -> tuple[Term, ...]:
    return terms((root / PAGE).read_text(encoding="utf-8"))


def test_the_terms_are_few_in_order_and_defined_once(root: Path, glossary: tuple[Term, ...]) -> None:
    lines = [line for line in (root / PAGE).read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    assert len(lines) - 1 == len(glossary), "a row is not `term | meaning | place`"
    assert 40 <= len(glossary) <= TERMS
    assert not (wrong := list(malformed(glossary))), "\n".join(wrong)


def test_every_place_is_there(glossary: tuple[Term, ...], sources: tuple[Source, ...]) -> None:
    assert not (wrong := list(lost(glossary, sources))), "\n".join(wrong)


def test_a_class_of_the_glossary_has_no_namesake(glossary: tuple[Term, ...], sources: tuple[Source, ...]) -> None:
    assert namesakes(glossary, sources) == NAMESAKES


BAD = """
| term | meaning | where |
|---|---|---|
| slab | A time step. It has a length. | `model.py: Slab` |
| gap | A distance. | `model.py: Slab.gap` |
| gap | A distance | `model.py` |
"""


def test_the_rules_find_what_they_forbid(tmp_path: Path) -> None:
    folder = tmp_path / "softway"
    folder.mkdir()
    (folder / "model.py").write_text("class Slab:\n    span: float\n")
    (folder / "other.py").write_text("class Slab:\n    pass\n")
    found, sources = terms(BAD), read_sources(folder)
    assert [term.word for term in found] == ["slab", "gap", "gap"]
    assert list(malformed(found)) == [
        "slab: not one sentence",
        "gap after slab",
        "gap after gap",
        "gap: not one sentence",
        "gap: no `module.py: name`",
    ]
    assert list(lost(found, sources)) == ["gap: model.py: Slab.gap"]
    assert namesakes(found, sources) == {"Slab": {"other.py"}}
