"""Time against error: uniform meshes, and meshes that follow waves and contacts."""

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
from processes.apart import HERE, Absent, Failed, environment, line
from record.figures import Figure

from groups.asked import Asked

WORDS = {
    "bar": "A02, force",
    "wave": "wave from a corner, tri3",
    "ball": "disc on a floor, tri3",
    "corner": "cube on a corner, tet4",
}
"""Problems by name."""


def adapted(asked: Asked) -> Iterator[Figure]:
    """Time against error, on uniform meshes and on meshes that follow waves and contacts: processor time of building
    and marching by one thread, and the error at the end of the run; the bar's is that of its contact force, of
    the exact one; others are those of the motion in the energy norm, of that on the uniform mesh of the finest cells,
    which counts as exact: a dashed line is its time.  The figures of a line of the picture are those of one kind of
    mesh with finer and finer cells.

    The bracket of ``scenarios/bracket_drop.toml`` has its edges halved twice: everywhere, and where the contact and the
    stress want it.  Its errors are those of the greatest von Mises stress of a cell and of the contact force against
    the uniform mesh, the greatest difference in 60 us over the greatest value.

    ![Processor time against error of four problems](../pictures/time_against_error.png)
    """
    for name, words in WORDS.items():
        found = _runs(asked, name)
        for plain, follows in zip(found[::2], found[1::2], strict=True):
            cells = f"adapted/{words}, cells of 1/{1.0 / plain['finest']:.0f}"
            yield Figure(name=f"{cells}, time", value=follows["cpu"], unit="s of the processor; uniform mesh",
                         baseline=plain["cpu"], ratio=follows["cpu"] / plain["cpu"])  # fmt: skip
            yield Figure(name=f"{cells}, error", value=100.0 * follows["error"], unit="%; uniform mesh",
                         baseline=100.0 * plain["error"])  # fmt: skip
            yield Figure(name=f"{cells}, nodes times slabs", value=follows["nodes"], unit="uniform mesh",
                         baseline=plain["nodes"], ratio=follows["nodes"] / plain["nodes"])  # fmt: skip

    yield from _bracket(asked)


def _bracket(asked: Asked) -> Iterator[Figure]:
    """Processor time, and differences of stress and force, of the dropped bracket."""
    levels = ["--levels", "3" if asked.smoke else "6"]
    try:
        found = line([sys.executable, str(HERE / "bracket.py"), *levels], environment(1))
    except Absent as why:
        raise Failed(f"bracket: {why}") from why
    plain, follows = found["uniform"], found["adapted"]
    yield Figure(name="adapted/bracket, time", value=follows["cpu"], unit="s of the processor; uniform mesh",
                 baseline=plain["cpu"], ratio=follows["cpu"] / plain["cpu"])  # fmt: skip
    yield Figure(name="adapted/bracket, nodes times slabs", value=follows["nodes"], unit="uniform mesh",
                 baseline=plain["nodes"], ratio=follows["nodes"] / plain["nodes"])  # fmt: skip
    for what in ("stress", "force"):
        ours, theirs = np.array(follows[what]), np.array(plain[what])
        apart = 100.0 * float(np.abs(ours - theirs).max() / theirs.max())
        yield Figure(name=f"adapted/bracket, {what}", value=apart, unit="% from the uniform mesh")


def _runs(asked: Asked, name: str) -> list[dict[str, Any]]:
    """The runs of a problem, uniform and adapted in turn."""
    more = ["--smallest"] if asked.smoke else []
    try:
        return list(line([sys.executable, str(HERE / "adapted.py"), name, *more], environment(1))["runs"])
    except Absent as why:
        raise Failed(f"{name}: {why}") from why
