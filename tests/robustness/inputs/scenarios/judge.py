"""Judgement of a mutated scenario: what ``check`` and ``run`` make of it, and that nothing of it is lost in silence."""

import re
import tempfile
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from inputs.command import FAILED, REFUSED, Answer, answer, traced, written
from inputs.mutations import meshes
from inputs.scenarios.mutants import mutant
from softway.errors import NumericsError
from softway.record.run import Run
from softway.scenario.checks.check import check
from softway.scenario.files import dumps, load
from softway.scenario.hints.units_text import Units

CHECK, RUN = 40, 15
"""Time for a check, and for the slabs of a run [s]."""
SLABS = 3
EMPTY = re.compile(r"error\s*:|error\s+[^:]*$|try:\s*(one of:\s*|known:\s*)?$", re.MULTILINE)
"""A message without place or without remedy."""


def judged_scenario(number: int) -> str:
    """Verdict on a mutated scenario: ``ok``, ``refused``, ``failed``, or a defect in words."""
    given = mutant(number)
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        written(place, {**meshes(), "a.toml": given.text})
        first = answer(place, ("check", "a.toml"), CHECK)
        wrong = _faults(first)
        if wrong or first.left:
            return wrong or f"files left by check: {sorted(first.left)}"
        if first.code:
            return {REFUSED: "refused", FAILED: "failed"}[first.code]
        try:
            scenario = load(place / "a.toml")
            lost = lost_values(tomllib.loads(given.text.decode()), tomllib.loads(dumps(scenario)), place)
            step = check(scenario).step
        except Exception as error:
            return traced(error)
        if lost:
            return f"lost: {'; '.join(lost)}"
        return _run(place, min(scenario.time.end, SLABS * step))


def _faults(given: Answer) -> str:
    """Defect of an answer: a traceback, a hang, a warning, or a message without remedy."""
    if given.defect or given.code not in (0, REFUSED, FAILED):
        return given.defect or f"exit {given.code}"
    if "Traceback" in given.told:
        return "traceback printed"
    if given.warned:
        return f"warning of Python: {given.warned[:150]}"
    if given.code and ("error" not in given.told or "try:" not in given.told):
        return f"exit {given.code} without remedy: {given.told[:150]!r}"
    if given.code == REFUSED and EMPTY.search(given.told):
        return f"no place or no remedy: {given.told[-150:]!r}"
    return ""


def _run(place: Path, end: float) -> str:
    """Verdict on the first slabs of a scenario that ``check`` has accepted."""
    words = ("a.toml", "--set", f"time.end={end!r}")
    done = answer(place, ("run", *words, "--out", "runs", "--quiet"), RUN)
    if done.defect.startswith("hang"):
        return "slow"
    wrong = _faults(done)
    if wrong:
        return f"run: {wrong}"
    if done.code == REFUSED:
        again = answer(place, ("check", *words), CHECK)
        told = done.told.strip()
        if again.code == REFUSED:
            return "ok" if "time." in told else f"refused with another end: {told[:150]!r}"
        return f"check {again.code} and run {done.code}: {told[:150]!r}"
    if done.left != {"runs"} and done.left:
        return f"files left by run: {sorted(done.left)}"
    return _records(place / "runs", done)


def _records(folder: Path, done: Answer) -> str:
    """Verdict on the records of a run."""
    if not folder.is_dir():
        return "failed" if done.code else "no records"
    history = Run(folder).history
    for name in history.columns if hasattr(history, "columns") else history:
        values = np.asarray(history[name], dtype=float)
        if "gap" in name:  # infinite where nothing is near
            values = values[~np.isposinf(values)]
        if np.isinf(values).any() or (np.isnan(values).any() and not np.isnan(values[0])):
            return f"{name} is not finite"
    return "failed" if done.code else "ok"


def lost_values(given: Any, read: Any, place: Path, where: str = "") -> list[str]:
    """Places of a scenario whose value is not in the scenario that was read from it."""
    if isinstance(given, Mapping):
        if not isinstance(read, Mapping):
            return [f"{where}: {given!r:.60} became {read!r:.60}"]
        if "library" in given:
            return []
        found = []
        for key, value in given.items():
            at = f"{where}.{key}".lstrip(".")
            if key == "kind" and key not in read:
                continue
            found += lost_values(value, read[key], place, at) if key in read else [f"{at} = {value!r:.60} is nowhere"]
        return found
    if isinstance(given, list) and isinstance(read, Mapping):  # short for the only key of a kind
        fits = [value for value in read.values() if not lost_values(given, value, place, where)]
        return [] if fits else [f"{where}: {given!r:.60} became {read!r:.60}"]
    if where.endswith(".normal") and not isinstance(read, list):
        read = [read]
    if isinstance(given, list) and isinstance(read, list):
        if where.endswith((".normal", ".axis")) and _parallel(given, read):
            return []
        if len(given) != len(read):
            return [f"{where}: {len(given)} entries became {len(read)}"]
        pairs = enumerate(zip(given, read, strict=True))
        return [text for k, (one, other) in pairs for text in lost_values(one, other, place, f"{where}[{k}]")]
    return [] if _same(given, read, place) else [f"{where}: {given!r:.60} became {read!r:.60}"]


def _parallel(given: list[Any], read: list[Any]) -> bool:
    """True for a direction that was brought to the length 1."""
    one, other = np.asarray(given, dtype=float), np.asarray(read, dtype=float)
    return one.shape == other.shape and bool(np.allclose(one / np.linalg.norm(one), other, rtol=0.0, atol=1e-12))


def _same(given: Any, read: Any, place: Path) -> bool:
    """True if a value means what was read: a quantity in another unit, a kind by its name, a lone entry."""
    if isinstance(read, Mapping):
        values = [value for key, value in read.items() if key != "kind"]
        return read.get("kind") == given or any(_same(given, value, place) for value in values) or not given
    if isinstance(read, list):
        return len(read) == 1 and _same(given, read[0], place)
    if given == read or str(place / str(given)) == read:
        return True
    one, other = (str(value).partition(" ") for value in (given, read))
    try:
        units = Units.standard()
        return bool(
            np.isclose(_si(units, one[0], one[2] or other[2]), _si(units, other[0], other[2]), rtol=1e-12, atol=0)
        )
    except (ValueError, NumericsError):
        return False


def _si(units: Units, number: str, unit: str) -> float:
    return float(units.registry.Quantity(float(number), unit or "dimensionless").to_base_units().magnitude)
