"""The gallery shows every scenario and example, by what their files say now, in small pictures."""

import importlib.util
import re
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
EXAMPLES = sorted((DOCS.parent / "examples" / "gallery").rglob("*.py"))
LARGEST = 80_000


def loaded(file):
    """A module of the documentation, as long as it is used."""
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules[file.stem]


@pytest.fixture(scope="module")
def gallery():
    yield from loaded(DOCS / "scripts" / "gallery.py")


@pytest.fixture(scope="module")
def pictures():
    yield from loaded(DOCS / "web" / "extensions" / "pictures.py")


def test_the_page_is_the_one_of_the_files(gallery):
    assert gallery.PAGE.read_text(encoding="utf-8") == gallery.page(), "python docs/scripts/gallery.py writes it"


def test_each_has_a_small_picture_and_a_sentence(gallery):
    found = list(gallery.entries())
    assert len(found) > 15
    for entry in found:
        assert 2_000 < entry.picture.stat().st_size < LARGEST, entry.picture
        first = re.split(r" The audit finds| `check` notes", entry.sentence)[0]
        assert 20 < len(first) < 250, entry.file
        assert len(entry.sentence) < 400, entry.file


def test_no_picture_is_left_over(gallery):
    assert {p.stem for p in gallery.PICTURES.iterdir()} == {entry.file.stem for entry in gallery.entries()}


def test_a_picture_becomes_small(gallery, tmp_path):
    gallery.shrink(DOCS / "pictures" / "bracket.png", tmp_path / "small" / "bracket.png")
    assert (tmp_path / "small" / "bracket.png").stat().st_size < LARGEST


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_told_in_blocks_draws_and_asserts(example):
    text = example.read_text(encoding="utf-8")
    title, rule = text.splitlines()[1:3]
    assert set(rule) == {"="} and len(rule) == len(title)
    assert text.count("\n# %%\n") >= 2
    assert re.search(r"^ *assert ", text, re.MULTILINE)
    for block in text.split("\n# %%\n"):  # the figures of a block are taken at its end
        assert "plt.subplots" in block or not re.search(r"\.(plot|loglog|add_collection|set)\(", block)
    assert max(map(len, text.splitlines())) <= 104  # what a page shows without scrolling


def test_every_example_has_its_place(pictures):
    assert sorted(pictures.ORDER) == sorted(example.stem for example in EXAMPLES)
    assert sorted(range(len(EXAMPLES)), key=lambda k: pictures.Order("")(f"{pictures.ORDER[k]}.py")) == [
        *range(len(EXAMPLES))
    ]
