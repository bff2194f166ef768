"""Decks of CalculiX's own tests, if they are on the machine: the package calculix-ccx-test of Debian."""

import gzip
import os
from pathlib import Path

import pytest

from softway.errors import InputError
from softway.meshes.files.mesh_files import read_mesh

PLACES = (os.environ.get("CALCULIX_TESTS", ""), "/usr/share/doc/calculix-ccx-test/examples/test")
SHARE = 0.6
"""Least share of the decks whose mesh is read."""


def decks() -> list[Path]:
    """Decks in the first place that has some."""
    found = [sorted(Path(place).glob("*.inp*")) for place in PLACES if place]
    return next((paths for paths in found if paths), [])


@pytest.mark.skipif(not decks(), reason="no decks: apt install calculix-ccx-test, or set CALCULIX_TESTS")
def test_most_meshes_are_read(tmp_path: Path) -> None:
    """At least 60 % are read; every other one is refused with a reason, none with the advice to save it again."""
    given = decks()
    read, refused = 0, []
    for path in given:
        text = path.read_bytes()
        deck = tmp_path / path.name.removesuffix(".gz")
        deck.write_bytes(gzip.decompress(text) if path.suffix == ".gz" else text)
        try:
            read += read_mesh(deck).n_cells > 0
        except InputError as error:
            refused.append((f"{deck.name}: {error.problem}", error.remedy))
    assert all(remedy and "save" not in remedy for _, remedy in refused)
    assert read >= SHARE * len(given), "\n".join(why for why, _ in refused)
