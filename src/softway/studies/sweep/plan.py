"""Plan of a sweep: all combinations of the values, and the folder name of each."""

import hashlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from softway.errors import InputError
from softway.scenario.text.override import steps

OPEN, CLOSED = "[{", "]}"
LONGEST = 60
"""Greatest length of the readable part of a folder name."""


@dataclass(frozen=True, slots=True)
class Trial:
    """Combination of values.

    Parameters
    ----------
    values
        Path and value, as text, of each swept parameter.

    Examples
    --------
    >>> Trial((("bodies.bar.mesh.cells", "20"), ("time.end", "4 s"))).name
    'cells-20.end-4s.038de8'
    """

    values: tuple[tuple[str, str], ...]

    @property
    def changes(self) -> tuple[str, ...]:
        """Changes of the scenario, as ``path=value``."""
        return tuple(f"{path}={value}" for path, value in self.values)

    @property
    def name(self) -> str:
        """Folder name; it does not depend on the other combinations or on the order of the paths."""
        ordered = sorted(self.values)
        words = [f"{steps(path)[-1]}-{re.sub(r'[^A-Za-z0-9.+-]', '', value)}" for path, value in ordered]
        check = hashlib.sha256(repr(ordered).encode()).hexdigest()
        return f"{'.'.join(words)[:LONGEST]}.{check[:6]}"


def trials(over: Mapping[str, Sequence[object]]) -> tuple[Trial, ...]:
    """All combinations of the values; the last path varies fastest.

    Raises
    ------
    InputError
        If there are no paths, or a path has no value or the same value twice.

    Examples
    --------
    >>> [t.changes for t in trials({"time.end": ["1 s", "2 s"]})]
    [('time.end=1 s',), ('time.end=2 s',)]
    """
    if not over:
        raise InputError("--over", "nothing to sweep over", "--over path=v1,v2, such as --over time.step=1e-3,2e-3")
    columns = []
    for path, values in over.items():
        if isinstance(values, str) or not isinstance(values, Iterable):
            raise InputError(path, f"{values!r} is not a list of values", f"several: {{'{path}': [v1, v2]}}")
        texts = [_text(value) for value in values]
        steps(path)
        if not texts or not all(texts):
            raise InputError(path, "a value is missing", f"{path}=v1,v2")
        for text in texts:
            if texts.count(text) > 1:
                raise InputError(path, f"{text!r} is given twice", "each value once")
        columns.append([(path, text) for text in texts])
    return tuple(Trial(combination) for combination in product(*columns))


def parsed(options: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Parse options ``path=v1,v2`` into paths and values; a comma inside brackets or quotes does not separate values.

    Examples
    --------
    >>> parsed(["time.end=1 s, 2 s", "bodies.a.velocity=[1,0],[2,0]"])
    {'time.end': ('1 s', '2 s'), 'bodies.a.velocity': ('[1,0]', '[2,0]')}
    """
    found: dict[str, tuple[str, ...]] = {}
    for option in options:
        path, sign, text = (part.strip() for part in option.partition("="))
        if not sign or not path:
            raise InputError("--over", f"{option!r} gives no values", "path=v1,v2, such as time.step=1e-3,2e-3")
        if path in found:
            raise InputError("--over", f"{path} is given twice", f"all its values at once: {path}=v1,v2")
        found[path] = _parted(text)
    return found


def _parted(text: str) -> tuple[str, ...]:
    """Values of a comma-separated list without brackets."""
    parts, depth, quote = [""], 0, ""
    for letter in text:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        depth += (letter in OPEN) - (letter in CLOSED) if not quote else 0
        if letter == "," and depth == 0 and not quote:
            parts.append("")
        else:
            parts[-1] += letter
    return tuple(part.strip() for part in parts)


def _text(value: object) -> str:
    """Text of a Python value, as written after ``path=``."""
    if isinstance(value, bool):
        return str(value).lower()
    return str(list(value) if isinstance(value, tuple) else value).strip()
