"""Check of a scenario of balls, which are marched as a pile."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from softway.bodies.setup.loads import Gravity
from softway.errors import InputError, Note, within
from softway.piles.arrays import ball_tables, motion, require_apart, wall_tables
from softway.piles.balls import Balls
from softway.piles.contacts import PileContacts
from softway.piles.groups import BallGroup, together
from softway.piles.march import FARTHEST
from softway.piles.pile import Pile
from softway.scenario.checks.mechanism import (
    gravity_of,
    require_default,
    require_no_parts,
    rows_between,
    slabs_of,
)
from softway.scenario.scenario import Scenario

FRAMES = 100
"""Number of stored instants when the scenario does not prescribe it."""
UNLIKE = 10.0
"""Ratio of the greatest to the smallest radius from which the search for contacts is slow."""
FOREIGN = {
    "contacts": "[pile] with friction and restitution: all balls may touch each other",
    "ties": "omit it: balls have no surfaces to glue",
    "start": "omit it: a pile starts with the places and velocities of its balls",
    "inertia": "omit it: balls always have their full mass",
    "solver": "pile.sweeps: the march of a pile has its own solution method",
}
"""Keys that a pile does not have, and remedies."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GroupScales:
    """Scales of a group of balls: number, radii [m], mass of all [kg], and greatest velocity at the start [m/s]."""

    balls: int
    radius_least: float
    radius_greatest: float
    mass: float
    speed: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CheckedPile:
    """Scenario of balls that has passed all checks.

    Parameters
    ----------
    scenario
        Scenario as given.
    pile
        Pile of the scenario, ready to march.
    bodies
        Scales of the groups by name, in the order of their balls.
    step, slabs
        Length of a time step (slab) [s] and number of slabs.
    every
        Number of slabs between two stored instants.
    notes
        Notes on parts of the scenario that are computed, although their results may be wrong.
    """

    scenario: Scenario
    pile: Pile
    bodies: Mapping[str, GroupScales]
    step: float
    slabs: int
    every: int
    notes: tuple[Note, ...] = ()


def is_pile(scenario: Scenario) -> bool:
    """True if the bodies of a scenario are groups of balls.

    Raises
    ------
    InputError
        If groups of balls are together with other bodies, or walls of a pile are given without balls.
    """
    groups = [name for name, body in scenario.bodies.items() if isinstance(body, BallGroup)]
    others = [name for name in scenario.bodies if name not in groups]
    if groups and others:
        other = f"the {type(scenario.bodies[others[0]]).__name__} {others[0]!r}"
        problem = f"{other} together with the balls {groups[0]!r}"
        remedy = "only BallList, BallLattice and BallFile, inside the walls of [pile]"
        raise InputError(f"bodies.{others[0]}.kind", problem, remedy)
    if not groups and scenario.pile != PileContacts():
        raise InputError("pile", "no body is a group of balls", 'bodies of kind = "BallLattice", or omit it')
    return bool(groups)


def check_pile(scenario: Scenario) -> CheckedPile:
    """Build the pile of a scenario and check all that a run refuses before its first slab (time step).

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    require_default(scenario, FOREIGN, "balls")
    require_no_parts(scenario)
    if scenario.output.probes:
        raise InputError("output.probes", "a probe of balls", "omit it: run.balls holds the motion of all balls")
    for k, load in enumerate(scenario.loads):
        if not isinstance(load, Gravity):
            raise InputError(f"loads[{k}]", f"{type(load).__name__} on {load.on!r} in a scenario of balls", "Gravity")
    groups = {}
    for name, body in scenario.bodies.items():
        if isinstance(body, BallGroup):
            with within(f"bodies.{name}"):
                groups[name] = body.build()
    with within("bodies"):
        balls = together(groups)
    with within("pile"):
        given = scenario.pile
        pile = Pile(
            balls=balls,
            walls=given.planes,
            gravity=gravity_of(scenario, balls.dim),
            friction=given.friction,
            restitution=given.restitution,
        )
    require_apart(ball_tables(pile), wall_tables(pile), motion(pile)[0])
    span, slabs = slabs_of(scenario.time, "balls")
    return CheckedPile(
        scenario=scenario,
        pile=pile,
        bodies={name: _scales(group) for name, group in groups.items()},
        step=span,
        slabs=slabs,
        every=rows_between(scenario.output, span, slabs, FRAMES),
        notes=tuple(_notes(pile, span)),
    )


def _scales(balls: Balls) -> GroupScales:
    """Scales of a group."""
    speed = 0.0 if balls.velocities is None else float(np.linalg.norm(balls.velocities, axis=1).max())
    return GroupScales(
        balls=balls.count,
        radius_least=float(balls.radii.min()),
        radius_greatest=float(balls.radii.max()),
        mass=float(balls.mass.sum()),
        speed=speed,
    )


def _notes(pile: Pile, span: float) -> Iterator[Note]:
    """Notes on balls that fall past all walls, on divided slabs, and on unlike radii."""
    gravity = np.zeros(pile.balls.dim) if pile.gravity is None else np.asarray(pile.gravity)
    radii, speed = pile.balls.radii, _scales(pile.balls).speed
    if gravity.any() and not any(np.dot(wall.normal, gravity) < 0.0 for wall in pile.walls):
        problem = "gravity, but no wall that balls could fall on"
        yield Note(where="pile.walls", problem=problem, remedy="a Box, or a Wall with a normal against gravity")
    way = span * (speed + span * float(np.linalg.norm(gravity)))
    if way > FARTHEST * radii.min():
        problem = f"balls move by {way:.3g} m in the first slab, more than half the smallest radius: slabs are divided"
        remedy = f"a shorter step, such as {FARTHEST * radii.min() / way * span:.2g} s"
        yield Note(where="time.step", problem=problem, remedy=remedy)
    if radii.max() > UNLIKE * radii.min():
        problem = f"radii from {radii.min():.3g} m to {radii.max():.3g} m: the search for contacts is slow"
        yield Note(where="bodies", problem=problem, remedy="radii that are alike")
