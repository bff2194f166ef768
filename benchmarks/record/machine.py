"""The machine and the versions, as figures."""

import os
import platform
import re
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from record.figures import Figure

PACKAGES = ("softway", "numpy", "scipy", "numba", "llvmlite", "pypardiso", "mkl", "scikit-sparse", "python-mumps")


def described() -> Iterator[Figure]:
    """Processor, cores, memory, system and versions."""
    yield Figure(name="machine/processor", value=_processor())
    yield Figure(name="machine/cores", value=str(os.cpu_count()))
    yield Figure(
        name="machine/memory", value=f"{os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30:.0f} GiB"
    )
    yield Figure(name="machine/load at the start", value=f"{os.getloadavg()[0]:.1f}")
    yield Figure(name="machine/system", value=f"{platform.system()} {platform.machine()}")
    yield Figure(name="machine/Python", value=platform.python_version())
    for package in PACKAGES:
        try:
            yield Figure(name=f"machine/{package}", value=version(package))
        except PackageNotFoundError:
            continue


def _processor() -> str:
    facts = Path("/proc/cpuinfo")
    found = re.search(r"model name\s*:\s*(.+)", facts.read_text()) if facts.is_file() else None
    return found[1] if found else platform.processor() or "unknown"
