"""Whether two run folders hold the same bits, but for dates and times on the clock."""

import json
from pathlib import Path

import h5py
import numpy as np

CLOCKS = {"summary.json": ("wall_time",), "provenance.json": ("start", "stop", "resumed")}
"""What differs between two runs of one scenario."""


def differences(one: Path, other: Path) -> list[str]:
    """What differs between two run folders, in words; nothing where they are the same."""
    names = sorted({p.relative_to(one) for p in one.rglob("*")} ^ {p.relative_to(other) for p in other.rglob("*")})
    found = [f"only one has {name}" for name in names]
    for file in sorted(p for p in one.rglob("*") if p.is_file() and (other / p.relative_to(one)).is_file()):
        found += [f"{file.name}: {what}" for what in _differ(file, other / file.relative_to(one))]
    return found


def _differ(one: Path, other: Path) -> list[str]:
    if one.suffix == ".vtkhdf":
        return _contents(one, other)
    if one.name in CLOCKS:
        first, second = (json.loads(p.read_text()) for p in (one, other))
        keys = (first.keys() | second.keys()) - set(CLOCKS[one.name])
        return [key for key in sorted(keys) if first.get(key) != second.get(key)]
    if one.read_bytes() == other.read_bytes():
        return []
    lines = zip(one.read_text().splitlines(), other.read_text().splitlines(), strict=False)
    return [f"line {next((k for k, (a, b) in enumerate(lines, 1) if a != b), 'after the end')}"]


def _contents(one: Path, other: Path) -> list[str]:
    """Datasets and attributes that differ between two files."""
    first, second = (_listed(p) for p in (one, other))
    return [name for name in sorted(first.keys() | second.keys()) if first.get(name) != second.get(name)]


def _listed(path: Path) -> dict[str, object]:
    found: dict[str, object] = {}

    def visit(name: str, item: h5py.Group | h5py.Dataset) -> None:
        found.update({f"{name}@{k}": (np.asarray(v).dtype, np.asarray(v).tobytes()) for k, v in item.attrs.items()})
        if isinstance(item, h5py.Dataset):
            values = np.asarray(item[()])
            content = values.tolist() if values.dtype == object else values.tobytes()
            found[name] = (item.shape, str(item.dtype), content)

    with h5py.File(path, "r", locking=False) as file:
        file.visititems(visit)
    return found
