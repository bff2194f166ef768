"""The sources as syntax trees, read once."""

from pathlib import Path

import pytest

from sources import Source, read_sources


@pytest.fixture(scope="session")
def root() -> Path:
    """Top folder of the repository."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def sources(root: Path) -> tuple[Source, ...]:
    """Modules of the package."""
    return read_sources(root / "src")
