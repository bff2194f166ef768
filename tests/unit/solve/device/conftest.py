"""Device of the tests, for which Warp has to be installed (make test-gpu)."""

import os

import pytest


@pytest.fixture(scope="session")
def device() -> str:
    """The processor, or the device of the variable SOFTWAY_TEST_DEVICE."""
    pytest.importorskip("warp", reason="needs Warp: pip install 'softway[gpu]', or make test-gpu")
    return os.environ.get("SOFTWAY_TEST_DEVICE") or "cpu"
