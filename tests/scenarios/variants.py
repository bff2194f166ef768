"""Small variants of the shipped scenarios: the same file with a few keys set, each run in about a second."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from softway.scenario.files import load
from softway.scenario.scenario import Scenario

SCENARIOS = Path(__file__).parents[2] / "scenarios"
OTHERS = (
    "bearing_clearance",
    "flat_follower",
    "freezing_corner",
    "hammer_on_stop",
    "newtons_cradle",
    "poured_balls",
    "rocking_block",
    "slider_crank",
    "squeezer",
    "thrown_ball",
    "tippe_top",
    "toggle_snap",
    "woodpecker",
)
"""Scenarios of rigid bodies, balls and conductors: tests/unit/scenario/mechanisms, piles and heat run them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """Small variant of a scenario.

    Parameters
    ----------
    changes
        Changes of the form ``path=value``, as for ``--set``.
    same
        Reason why it is still about the same physics.
    held
        Body -> tag -> indices of the components that jitter leaves alone.
    sensitive
        Reason why even the smallest movements change the order of its touches; empty if they do not.
    """

    changes: tuple[str, ...]
    same: str
    held: Mapping[str, Mapping[str, tuple[int, ...]]] = field(default_factory=dict)
    sensitive: str = ""


VARIANTS: Mapping[str, Variant] = {
    "bag": Variant(
        changes=(
            'bodies.ball.copies=[["1 mm", "-70 mm"], ["27 mm", "-66 mm"]]',
            'bodies.ball.velocity=["0 m/s", "-1 m/s"]',
            "time.end=16 ms",
        ),
        same="the same bag catches two balls, which are thrown into it close together",
    ),
    "ball_impact": Variant(
        changes=("bodies.ball.mesh.cells=4", "time.end=3 s", "time.step=0.1 s"),
        same="the ball is flattened and leaves the plane at 2.9 s; only the mesh is coarse",
    ),
    "bar_through_die": Variant(
        changes=(
            'bodies.bar.mesh.size=["40 mm", "10 mm"]',
            'bodies.bar.mesh.origin=["-47 mm", "0 mm"]',
            "bodies.bar.mesh.cells=[20, 4]",
            'bodies.die.shape.centre=["0 mm", "15 mm"]',
            "bodies.die.shape.radius=8 mm",
            "time.end=7.3 ms",
        ),
        same="same cells, throat and drive; half of the bar starts nearer to shorter lips, which squeeze it as much: "
        "nodes enter the throat, and the first one leaves it",
        held={"bar": {"bottom": (1,), "left": (0,)}},  # plane of symmetry, driven side
    ),
    "beam_on_cylinder": Variant(
        changes=(
            "bodies.beam.mesh.cells=[16, 2]",
            "bodies.cover.mesh.cells=[1, 18]",
            "time.end=1.5 ms",
            "time.step=0.1 ms",
        ),
        same="the beam slaps onto the roller flat, lifts off, and the wave that returns presses it down again",
    ),
    "beam_swing": Variant(
        changes=("bodies.beam.mesh.cells=[20, 1, 1]", "time.end=60 s", "time.step=4 s"),
        same="the beam swings to one side and back; its angle is as large",
        held={"beam": {"left": (0,)}},  # clamped side
    ),
    "billiard_break": Variant(
        changes=(
            'bodies.ball.copies=[["0 mm", "0 mm"], ["49 mm", "28.2 mm"], ["49 mm", "-28.2 mm"]]',
            "output.probes[1].of=ball3",
            "time.end=1.6 ms",
            "time.step=30 us",
        ),
        same="the same ball hits the first three, with longer slabs, until they have shared the impact",
    ),
    "block_on_sphere": Variant(
        changes=("bodies.block.mesh.cells=[3, 3, 3]", "time.end=2.8 ms", "time.step=80 us"),
        same="the block hits the ball off-centre, turns, and its last node leaves the ball at 2.6 ms",
    ),
    "brake_pad": Variant(
        changes=("bodies.pad.mesh.cells=[2, 20]", "time.end=0.5 s"),
        same="the pad is pressed, the disc begins to run, and friction heats the surface; longer cells",
        held={
            "pad": {"left": (0,), "right": (0,), "top": (1,), "bottom": (1,)}
        },  # sides, driven back, face on the disc
    ),
    "bouncing_bar": Variant(
        changes=("bodies.bar.mesh.cells=10", "time.end=1.8 s"),
        same="the bar falls from rest and bounces once: touch at 1 s, release after 2 L / c = 2/3 s",
    ),
    "bracket_drop": Variant(
        changes=("time.end=64 us", "time.step=4 us"),
        same="same mesh; the corner lands, the impact runs along the edge, and the corner leaves the floor again",
        held={"bracket": {"base": (0, 2)}},  # the straight edge that lands: its nodes lie 40 um above each other
    ),
    "cam_follower": Variant(
        changes=("time.end=1.2 ms",),
        same="same mesh and slabs; the rod rides on the cam and leaves it before the top; only the flight is left out",
        held={"rod": {"tip": (0, 1), "guide": (0,)}},  # contact that starts closed, guide
    ),
    "chain": Variant(
        changes=(
            'bodies.across.copies=[["27 mm", "0 mm", "0 mm"]]',
            'bodies.along.copies=[["54 mm", "0 mm", "0 mm"]]',
            "output.probes[0].of=along1",
            "time.end=1.5 ms",
        ),
        same="three links of the same mesh: the first two tighten, and the third follows",
        sensitive="nodes and edges of links at right angles meet at once; which are first decides what follows",
    ),
    "crash_tube": Variant(
        changes=(
            'bodies.tube.mesh.size=["1.5 mm", "12 mm"]',
            "bodies.tube.mesh.cells=[2, 5]",
            "bodies.tube.mesh.cell=quad8",
            "bodies.tube.dilatation=point",
            'bodies.tube.supports[2].velocity=["0 m/s", "-120 m/s"]',
            'bodies.tube.supports[2].times=["0 ms", "30 us"]',
            "time.end=82.6 us",
            "time.step=2 us",
        ),
        same="the same wall, as long as one fold, which closes until it touches itself; twice as fast, and a few "
        "quadratic cells, as linear ones would be many",
        held={"tube": {"bottom": (0, 1), "top": (0, 1), "left": (0,), "right": (0,)}},  # clamped ends; buckling faces
    ),
    "disc_on_block": Variant(
        changes=("bodies.block.adapt.levels=4", "bodies.disc.adapt.levels=2", "time.end=0.4 ms", "time.step=20 us"),
        same="the same bodies meet; larger cells at the finest, until the wave has come into the block",
        held={"disc": {"boundary": (0, 1)}, "block": {"top": (0, 1)}},  # a circle and a line
        sensitive="which of the equal edges of a base cell is cut first, and with it the mesh, changes",
    ),
    "elastic_cradle": Variant(
        changes=(*(f"bodies.disc{k}.mesh.cells=8" for k in range(1, 6)), "time.end=5 ms", "time.step=0.5 ms"),
        same="the same discs and rods; coarser discs, until the pulse has reached the third",
        held={f"disc{k}": {"boundary": (0, 1)} for k in range(1, 6)},  # vertices that meet vertices, exactly
    ),
    "flexible_crank": Variant(
        changes=("bodies.rod.mesh.cells=[6, 1]", "time.end=8 ms", "time.step=1 ms"),
        same="same crank, rod and slider; the first twentieth of a turn",
    ),
    "hammer_on_beam": Variant(
        changes=("bodies.beam.mesh.cells=[20, 2]", "time.end=4 ms", "time.step=0.16 ms"),
        same="the same hammer hits the same beam; fewer cells, and the first hit only",
    ),
    "glued_glass": Variant(
        changes=(
            "bodies.housing.mesh.cells=[5, 2, 2]",
            "bodies.glass.mesh.cells=[3, 2, 1]",
            "time.end=0.4 ms",
            "time.step=20 us",
        ),
        same="the edge touches and springs up; glued meshes that do not match, only coarse",
        held={"housing": {"bottom": (0, 1, 2)}},  # contact that starts closed
    ),
    "peeled_strip": Variant(
        changes=("bodies.plate.mesh.cells=[10, 1]", "time.end=0.4 s", "time.step=40 ms"),
        same="the same strip on a coarser plate; the first millimetres of the crack",
        held={"strip": {"bottom": (0, 1)}, "plate": {"top": (0, 1)}},  # surfaces that lie on each other
    ),
    "hot_ring": Variant(
        changes=("bodies.ring.mesh.cells=[6, 4]", "time.end=0.1 s"),
        same="same dies, heat and slabs; a quarter of the way down, with longer cells",
        held={"ring": {"bottom": (1,), "top": (1,)}},  # plane of symmetry, contact that starts flush
    ),
    "oblique_blocks": Variant(
        changes=(
            'contacts[0].between=["thrown.bottom", "still.top"]',
            "bodies.still.mesh.cells=[2, 2, 2]",
            "bodies.thrown.mesh.cells=[2, 2, 2]",
            "time.end=2.1 ms",
            "time.step=0.15 ms",
        ),
        same="the lower edge of the tilted block hits the upper face of the other, and leaves it at 1.6 ms; the sides, "
        "which do not meet, carry the mass",
    ),
    "paper_bar": Variant(
        changes=("time.end=3 s", "time.step=0.05 s"),
        same="touch at 0.3 s, release after 2.3 s; longer slabs only",
    ),
    "paper_bar_fixed": Variant(
        changes=("time.end=3 s", "time.step=0.05 s"),
        same="the held bar meets its stop and leaves it; longer slabs only",
    ),
    "ring_in_ring": Variant(
        changes=(
            "bodies.small.mesh.cells=[2, 40]",
            "bodies.large.mesh.cells=[2, 48]",
            "time.end=3.4 ms",
            "time.step=0.1 ms",
        ),
        same="the small ring flies and hits the large one; nodes touch and let go, and both rings begin to bend",
    ),
    "ring_test": Variant(
        changes=("bodies.ring.mesh.cells=[6, 3]", "time.end=0.1 s"),
        same="same platen, friction and slabs; a third of the way down",
        held={"ring": {"bottom": (1,), "top": (1,)}},  # plane of symmetry, contact that starts flush
    ),
    "upsetting": Variant(
        changes=(
            "bodies.cylinder.mesh.cells=[4, 4]",
            "bodies.cylinder.remesh={ ratio = 1.3 }",
            "time.end=0.24 s",
            "time.step=20 ms",
        ),
        same="the same press, to a third, with limits of the cells that they reach there: the mesh is replaced",
        held={"cylinder": {"bottom": (1,), "left": (0,), "top": (1,)}},  # symmetry, axis, contact that starts flush
    ),
    "phone_drop": Variant(
        changes=(
            "bodies.glass.mesh.cells=[4, 2, 1]",
            "time.end=60 us",
            "time.step=15 us",
        ),
        same="the same parts with a coarser pane; the corner lands, and the glue takes the pane along",
        held={
            "frame": {"front": (0, 1, 2), "screws": (0, 1, 2)},
            "glass": {"top": (0, 1, 2)},
            "cover": {"inside": (0, 1, 2)},
        },  # glued surfaces
    ),
    "sandwich_plate": Variant(
        changes=(
            "bodies.plate.mesh.mesh.cells=[30, 4]",
            "bodies.ball.mesh.cells=8",
            "time.end=40 us",
            "time.step=2 us",
        ),
        same="the same ball and layers: the front face yields, and the core carries the load on; longer cells",
        held={"plate": {"top": (1,)}, "ball": {"boundary": (1,)}},  # the gap is a twentieth of a cell
    ),
    "folded_strip": Variant(
        changes=("bodies.strip.mesh.cells=[2, 24]", "time.end=40 ms", "time.step=0.5 ms"),
        same="half as many cells along the strip; it buckles and its loads are the same",
        held={"strip": {"bottom": (0, 1), "top": (0, 1)}},  # lie on the floor, and on the line that is driven
    ),
    "shrink_fit": Variant(
        changes=("bodies.shaft.mesh.cells=[5, 2]", "bodies.ring.mesh.cells=[4, 1]", "time.end=60 s", "time.step=4 s"),
        same="the ring cools through the air, touches the shaft and is pressed on it; longer cells and slabs",
        held={  # axis and plane of symmetry, surfaces that are a thousandth of a cell apart
            "shaft": {"left": (0,), "right": (0,), "bottom": (1,)},
            "ring": {"left": (0,), "bottom": (1,)},
        },
    ),
    "casting": Variant(
        changes=(
            "bodies.casting.mesh.cells=[4, 3]",
            "bodies.mould.mesh.cells=[2, 3]",
            "time.end=12 s",
            "time.step=2 s",
        ),
        same="the casting cools, freezes at the wall and leaves it; larger cells, longer slabs, a seventh of the time",
        held={  # axis and plane of symmetry, surfaces that start flush
            "casting": {"left": (0,), "right": (0,), "bottom": (1,)},
            "mould": {"left": (0,), "bottom": (1,)},
        },
    ),
    "freezing_drop": Variant(
        changes=("bodies.drop.mesh.cells=3", "time.step=75 us", "time.end=1.2 ms"),
        same="the drop spreads and begins to freeze; larger cells, shorter slabs, a fifth of the time",
        held={"drop": {"axis": (0,), "boundary": (0, 1)}},  # the drop starts in touch with the plate
    ),
    "snap_fit": Variant(
        changes=("time.end=3 ms", "time.step=20 us"),
        same="the nose meets the catch and rides up on it, with friction; longer slabs, nearly half of the way in",
    ),
    "stamp_on_pad": Variant(
        changes=(
            "bodies.pad.mesh.cells=[5, 5, 2]",
            'bodies.stamp.motion.times=["0 ms", "2 ms", "4 ms"]',
            "time.end=4 ms",
            "time.step=0.25 ms",
        ),
        same="the same way of the stamp, pressed and lifted, in less time and into fewer cells",
    ),
    "taylor_bar_hot": Variant(
        changes=("bodies.rod.mesh.cells=[2, 14]", "time.step=0.8 us", "time.end=5.6 us"),
        same="same rod, speed and softening; the foot is hot after a tenth of the time",
        held={"rod": {"bottom": (1,), "left": (0,)}},  # contact that starts flush, axis
    ),
}
"""Variant of every scenario, by the name of its file."""


LONG = frozenset({"bag", "bar_through_die", "chain", "phone_drop", "snap_fit"})
"""Scenarios whose small variants, too, take tens of seconds where they run several times or with many frames."""


def each() -> list[Any]:
    """Parameters of a test of every small variant: those of ``LONG`` are for the tests that take minutes."""
    return [pytest.param(name, marks=pytest.mark.minutes if name in LONG else []) for name in sorted(VARIANTS)]


def names() -> list[str]:
    """Names of the shipped scenarios of solids."""
    return sorted(file.stem for file in SCENARIOS.glob("*.toml") if file.stem not in OTHERS)


def whole(name: str) -> Scenario:
    """Scenario as it is shipped."""
    return load(SCENARIOS / f"{name}.toml")


def small(name: str, *more: str) -> Scenario:
    """Small variant of a scenario, with ``more`` changes."""
    return load(SCENARIOS / f"{name}.toml", (*VARIANTS[name].changes, *more))
