"""How the pictures of the examples look, and the order in which the examples stand."""

import logging
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt

from softway.record.view.style import CYCLE, STYLE

ORDER = (
    "bar_on_wall", "cradle", "hundred_bounces", "ball_on_plane", "two_discs",
    "time_functions", "finer_meshes", "fixed_point_and_newton",
    "press_fit", "wavy_tool", "sliding_block", "spin",
    "upsetting", "own_law",
)  # fmt: skip


def plain(_settings: Any, _file: str) -> None:
    """Colours and lines as in the pictures of ``softway plot``; and no log, which a package of the theme prints."""
    logging.getLogger("softway").setLevel(logging.WARNING)
    plt.rcParams.update(STYLE)
    plt.rcParams["axes.prop_cycle"] = plt.cycler(color=CYCLE)


class Order:
    """Key that sorts the files of examples."""

    def __init__(self, _folder: str) -> None:
        pass

    def __call__(self, file: str) -> int:
        """Place of a file; a new one has to be given one."""
        return ORDER.index(Path(file).stem)
