"""Figures: what was measured, against what, and whether that is enough; their file, and the comparison of two files."""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from math import isfinite
from pathlib import Path

from record.fingerprint import Origin

KEYS = ("name", "value", "unit", "baseline", "ratio", "target", "pass")
SLACK = 0.2
"""Part by which a ratio may get worse before it counts."""
STORED = "baseline of an earlier run"
"""Words in the unit of a figure whose baseline was not measured in the same run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """One measurement.

    Parameters
    ----------
    name
        Group and what was measured, separated by ``/``.
    value, unit
        The number or text, and in what.
    baseline
        What the value is compared with, in the same unit.
    ratio
        How they compare.
    target
        ``>= x`` or ``<= x`` for the ratio, or for the value where there is no ratio; ``higher`` or ``lower`` where only
        the direction is given.
    """

    name: str
    value: float | str
    unit: str = ""
    baseline: float | None = None
    ratio: float | None = None
    target: str | None = None

    @property
    def passed(self) -> bool | None:
        """Whether the target is met; none without a bound."""
        number = self.value if self.ratio is None else self.ratio
        if self.target is None or self.target[:2] not in (">=", "<=") or isinstance(number, str):
            return None
        bound = float(self.target[2:])
        return bool(number >= bound if self.target.startswith(">=") else number <= bound)

    @property
    def more_is_better(self) -> bool:
        """Whether a greater ratio is the better one."""
        return (self.target or "").startswith((">=", "higher"))

    @property
    def finite(self) -> bool:
        """Whether all of its numbers are."""
        return all(isfinite(n) for n in (self.value, self.baseline, self.ratio) if isinstance(n, float | int))

    @property
    def comparable(self) -> bool:
        """Whether the ratio tells something about the code alone."""
        return self.ratio is not None and self.target is not None and STORED not in self.unit


def speedup(name: str, value: float, baseline: float, unit: str, target: str = "higher") -> Figure:
    """A time against the longer one of something else."""
    return Figure(name=name, value=value, unit=unit, baseline=baseline, ratio=baseline / value, target=target)


def written(path: Path, figures: Iterable[Figure], origins: Mapping[str, Origin]) -> None:
    """Write the list of figures, under where those of each group come from."""
    rows = []
    for f in figures:
        rows.append(dict(zip(KEYS, (f.name, f.value, f.unit, f.baseline, f.ratio, f.target, f.passed), strict=True)))
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = ",\n".join(json.dumps({k: _short(v) for k, v in row.items()}) for row in rows)
    groups = ",\n".join(
        f"{json.dumps(group)}: {json.dumps({k: _short(v) for k, v in asdict(origin).items()})}"
        for group, origin in origins.items()
    )
    path.write_text(f'{{"origins": {{\n{groups}\n}},\n"figures": [\n{lines}\n]}}\n', encoding="utf-8")


def read(path: Path) -> tuple[dict[str, Figure], dict[str, Origin]]:
    """The figures of a file by their names, and their origins by groups; none where there is no file."""
    if not path.is_file():
        return {}, {}
    found = json.loads(path.read_text(encoding="utf-8"))
    figures = {row["name"]: Figure(**{k: v for k, v in row.items() if k != "pass"}) for row in found["figures"]}
    return figures, {group: Origin(**facts) for group, facts in found["origins"].items()}


def regressions(new: Mapping[str, Figure], stored: Mapping[str, Figure], slack: float = SLACK) -> dict[str, str]:
    """What got worse by more than ``slack``, by name, with both ratios.

    Times by the clock are left out where the processor's time of the same work is known: other work spoils them.
    """
    worse = {}
    for name, now in new.items():
        then = stored.get(name)
        if then is None or not (now.comparable and then.comparable) or _by_processor(name) in new:
            continue
        assert now.ratio is not None and then.ratio is not None
        bound = (1.0 - slack if now.more_is_better else 1.0 + slack) * then.ratio
        if now.ratio < bound if now.more_is_better else now.ratio > bound:
            worse[name] = f"{then.ratio:.3g} -> {now.ratio:.3g}"
    return worse


def unmatched(new: Mapping[str, Figure], stored: Mapping[str, Figure]) -> tuple[list[str], list[str]]:
    """Names of ratios that only the one has, and of those that only the other has."""
    ours, theirs = ({n for n, f in each.items() if f.comparable} for each in (new, stored))
    return sorted(ours - theirs), sorted(theirs - ours)


def _by_processor(name: str) -> str:
    return re.sub(r", \d threads?$", "", name) + ", processor"


def _short(value: object) -> object:
    return float(f"{value:.5g}") if isinstance(value, float) else value
