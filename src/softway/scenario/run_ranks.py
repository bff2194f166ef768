"""March of a checked scenario over ranks: rank 0 records the steps, the others assist."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from softway.cluster.admitted import REMEDY, require_several
from softway.cluster.march import march_on
from softway.errors import Cancel, InputError
from softway.marching.results.step import Step
from softway.marching.results.trying import TryWatch
from softway.marching.state.march_state import MarchState
from softway.model.scene import State
from softway.ranks.alone import Alone
from softway.ranks.interface import Ranks
from softway.ranks.launch import agreed
from softway.scenario.checks.check import Checked
from softway.scenario.run_rigid import CheckedRigid


def require_ranks(checked: Checked | CheckedRigid, size: int) -> None:
    """Refuse a scenario that runs on one rank only.

    Raises
    ------
    InputError
        With the place in the scenario.
    """
    if not isinstance(checked, Checked):
        raise InputError("scenario", "runs on one rank only: rigid bodies, balls or conductors alone", REMEDY)
    require_several(checked.model, checked.scenario.solver, size)


def ranks_of(record: Mapping[str, Any], ranks: Ranks | None) -> Ranks | None:
    """Ranks that continue a run with this record: those given, else one alone for a run over ranks, else none.

    Raises
    ------
    InputError
        On all ranks, if the run was none over ranks: its operator and its sums are others.
    """
    if not record.get("ranks"):
        if ranks is not None:
            problem = f"{ranks.size}, for a run without ranks, whose results they would change by rounding"
            raise InputError("--ranks", problem, "softway resume FOLDER, without --ranks")
        return None
    return Alone() if ranks is None else ranks


def steps_of_ranks(
    ranks: Ranks,
    checked: Checked,
    state: State | MarchState | None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step]:
    """Steps of the march on rank 0, from its ``state``; none on the others."""
    march = march_on(ranks, checked.model, checked.march_state.settings, ranks.told(state), cancel, trying)
    return (step for step in march if step is not None)


def assist(ranks: Ranks, read: Callable[[], Checked | CheckedRigid], record: Mapping[str, Any] | None = None) -> int:
    """March with rank 0, which records the steps, to the end; the exit code 0.

    The scenario is ``read`` here, and the whole model kept no longer than it takes to begin.  With the ``record`` of a
    run that stopped, rank 0 continues this run.
    """
    for _ in _assisting(ranks, read, record):
        pass
    return 0


def _assisting(
    ranks: Ranks, read: Callable[[], Checked | CheckedRigid], record: Mapping[str, Any] | None
) -> Iterator[Step]:
    """March of a rank that assists."""
    checked = read()
    if record is not None:
        ranks_of(record, ranks)
    require_ranks(checked, ranks.size)
    assert isinstance(checked, Checked)
    agreed(ranks, lambda: None)  # on the folder, and the checkpoint, of rank 0
    return steps_of_ranks(ranks, checked, None)
