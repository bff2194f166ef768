"""The reference has every public name once, and names nothing that is not there."""

import re
from collections import Counter
from importlib import import_module
from pathlib import Path

import pytest

import softway as sw
from softway.public_names import PACKAGES
from softway.scenario.class_index import classes
from softway.scenario.hints.docstrings import described
from softway.scenario.hints.type_hints import inputs

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
PAGES = sorted(REFERENCE.rglob("*.md"))
NAMED = re.compile(r"^\.\. auto(class|function|exception):: (\S+)\n((?:   :.*\n)*)", re.MULTILINE)
ENTRIES = [(page.stem, *found) for page in PAGES for found in NAMED.findall(page.read_text(encoding="utf-8"))]


def located(name: str) -> object:
    """The thing of a name on a page; those without a module are softway's own."""
    module, _, last = (name if name.startswith("softway.") else f"softway.{name}").rpartition(".")
    return getattr(import_module(module), last)


def test_every_public_name_is_on_one_page():
    found = Counter(located(name) for _, _, name, _ in ENTRIES)
    packages = [sw, *(getattr(sw, name) for name in PACKAGES)]
    public = {f"{p.__name__}.{name}": getattr(p, name) for p in packages for name in p.__all__}
    assert {name: found[thing] for name, thing in public.items() if found[thing] != 1} == {}
    assert set(found.values()) == {1}


@pytest.mark.parametrize(("page", "kind", "name", "options"), ENTRIES, ids=[entry[2] for entry in ENTRIES])
def test_what_a_page_names_is_there(page, kind, name, options):
    thing = located(name)
    expected = "exception" if isinstance(thing, type) and issubclass(thing, Exception) else "class"
    assert kind == (expected if isinstance(thing, type) else "function")
    assert thing.__doc__
    for member in re.findall(r"\w+", options.replace(":members:", "")):
        assert getattr(thing, member).__doc__, member


def test_the_index_lists_every_page():
    index = (REFERENCE / "index.md").read_text(encoding="utf-8")
    pages = {page.relative_to(REFERENCE).with_suffix("").as_posix() for page in PAGES}
    assert set(re.findall(r"^([\w/]+)$", index, re.MULTILINE)) == pages - {"index"}


@pytest.mark.parametrize("cls", classes(), ids=lambda cls: f"{cls.__module__}.{cls.__name__}")
def test_every_key_of_a_scenario_is_told(cls):
    assert inputs(cls).keys() - described(cls).fields.keys() == set()
