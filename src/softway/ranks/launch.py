"""Start of ranks as processes, and their agreement on what may fail on one of them alone."""

import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TypeVar

import numpy as np

from softway.errors import InputError, SoftwayError
from softway.ranks.alone import Alone
from softway.ranks.interface import Ranks
from softway.ranks.mpi import launched, processes

Result = TypeVar("Result")
REMEDY = "pip install 'softway[mpi]' mpich, or on a cluster its MPI and pip install 'softway[mpi]'"


def launcher() -> str:
    """Path of ``mpiexec``, beside Python or on the path.

    Raises
    ------
    InputError
        Without mpi4py or ``mpiexec``.
    """
    if find_spec("mpi4py") is None:
        raise InputError("--ranks", "mpi4py is not installed", REMEDY)
    found = shutil.which("mpiexec", path=str(Path(sys.executable).parent)) or shutil.which("mpiexec")
    if found is None:
        raise InputError("--ranks", "there is no mpiexec beside Python or on the path", REMEDY)
    return found


def started(count: int, arguments: Sequence[str]) -> int:
    """Exit code of the command ``softway`` with these arguments on a number of processes."""
    command = [launcher(), "-n", str(count), sys.executable, "-m", "softway", *arguments]
    return subprocess.run(command, check=False).returncode


def without_option(arguments: Sequence[str], name: str) -> list[str]:
    """Arguments without an option and its value.

    Examples
    --------
    >>> without_option(["run", "a.toml", "--ranks", "4", "-q"], "--ranks")
    ['run', 'a.toml', '-q']
    >>> without_option(["run", "--ranks=4", "a.toml"], "--ranks")
    ['run', 'a.toml']
    """
    out, skip = [], False
    for argument in arguments:
        if skip:
            skip = False
        elif argument == name:
            skip = True
        elif not argument.startswith(f"{name}="):
            out.append(argument)
    return out


def ranks_here(asked: int | None) -> Ranks | None:
    """Ranks of this process: those of a launcher, one alone if that was ``asked`` for; None without any.

    Raises
    ------
    InputError
        If less than one rank is asked for, or another number than the launcher started.
    """
    if asked is not None and asked < 1:
        raise InputError("--ranks", f"{asked}", "1 or more")
    if not launched():
        return Alone() if asked == 1 else None
    found = processes()
    if asked not in (None, found.size):
        raise InputError("--ranks", f"{asked}, where the launcher started {found.size}", "only one of the two numbers")
    return found


def agreed(ranks: Ranks, action: Callable[[], Result]) -> Result:
    """Result of an action that every rank does on its own; if it fails on one of them, it fails on all.

    Raises
    ------
    SoftwayError
        The error of this rank, or on the others an :class:`~softway.errors.InputError` that names the first rank that
        failed.
    """
    problem: SoftwayError | None = None
    try:
        result = action()
    except SoftwayError as error:
        problem = error
    told = [str(text[0]) for text in ranks.gathered(np.array([str(problem or "")]))]
    if problem is not None:
        raise problem
    for rank, text in enumerate(told):
        if text:
            raise InputError(f"rank {rank}", text)
    return result


def together(ranks: Ranks | None, action: Callable[[], Result]) -> Result:
    """:func:`agreed` result of an action if there are ranks, else the result; errors as those of the action."""
    return action() if ranks is None else agreed(ranks, action)
