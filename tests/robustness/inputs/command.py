"""The command line in a folder of its own: its exit code, what it says, and what it leaves."""

import contextlib
import io
import os
import signal
import traceback
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

REFUSED, FAILED, INTERRUPTED = 2, 3, 130


class TooLong(BaseException):
    """The input took more than its time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """What a command answered.

    Parameters
    ----------
    code
        Exit code; None if there is none.
    defect
        A traceback or a hang, in words; empty without one.
    told, warned
        Texts of the error stream, and of the warnings of Python.
    left
        Names of new files and folders.
    """

    code: int | None
    defect: str = ""
    told: str = ""
    warned: str = ""
    left: frozenset[str] = frozenset()


def answer(place: Path, words: Sequence[str], seconds: int) -> Answer:
    """Answer of a command in a folder, within some time."""
    from softway.apps.cli import main

    before, home = set(os.listdir(place)), Path.cwd()
    out, errors = io.StringIO(), io.StringIO()
    code, defect = None, ""
    os.chdir(place)
    signal.signal(signal.SIGALRM, _stop)
    signal.alarm(seconds)
    try:
        with (
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(errors),
            warnings.catch_warnings(record=True) as warned,
        ):
            warnings.simplefilter("always")
            code = main(list(words))
    except TooLong:
        defect = f"hang: more than {seconds} s"
    except SystemExit as stop:
        defect = f"left by SystemExit {stop.code}"
    except Exception as error:
        defect = traced(error)
    finally:
        signal.alarm(0)
        os.chdir(home)
    texts = [f"{w.category.__name__} {w.message} at {Path(w.filename).name}:{w.lineno}" for w in warned]
    left = frozenset(os.listdir(place)) - before
    return Answer(code=code, defect=defect, told=errors.getvalue(), warned="; ".join(texts), left=left)


def traced(error: BaseException) -> str:
    """An exception with its place, as a defect."""
    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"traceback: {type(error).__name__}: {str(error)[:80]} at {Path(where.filename).name}:{where.lineno}"


def written(place: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a folder."""
    for name, data in files.items():
        Path(place, name).write_bytes(data)


def _stop(*_: object) -> None:
    raise TooLong
