"""March of a checked scenario over ranks: rank 0 records the steps, the others assist."""

from collections.abc import Iterator

from softway.cluster.admitted import REMEDY, require_several
from softway.cluster.march import march_on
from softway.errors import Cancel, InputError
from softway.marching.results.step import Step
from softway.marching.results.trying import TryWatch
from softway.marching.state.march_state import MarchState
from softway.model.scene import State
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


def steps_of_ranks(
    ranks: Ranks,
    checked: Checked,
    state: State | MarchState | None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step]:
    """Steps of the march on rank 0, from its ``state``; none on the others."""
    begin = ranks.told(state)
    for step in march_on(ranks, checked.model, checked.march_state.settings, begin, cancel, trying):
        if step is not None:
            yield step


def assist(ranks: Ranks, checked: Checked | CheckedRigid) -> int:
    """March with rank 0, which records the steps, to the end; the exit code 0."""
    require_ranks(checked, ranks.size)
    assert isinstance(checked, Checked)
    agreed(ranks, lambda: None)  # on the folder of rank 0
    for _ in steps_of_ranks(ranks, checked, None):
        pass
    return 0
