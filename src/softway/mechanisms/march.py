"""March of a mechanism: slabs (time steps) in compiled loops."""

from collections.abc import Iterator

import numpy as np

from softway.errors import InputError
from softway.mechanisms.arrays import MechanismState
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.step import MechanismGroup, MechanismStep
from softway.mechanisms.walk import walk_of
from softway.units import Second

MOST = 1e15
"""Number of slabs that no march takes."""


def march(
    mechanism: Mechanism, *, until: Second, step: Second, every: int = 1, state: MechanismState | None = None
) -> Iterator[MechanismStep]:
    """March a mechanism; yields the state at the start, and after every ``every`` slabs and at the end.

    Positions and velocities satisfy the joints at the end of every slab.  The energy of conservative mechanisms,
    momentum and angular momentum are kept.  Velocities at the start that the joints do not allow are replaced by the
    nearest ones in the norm of the mass.

    Parameters
    ----------
    mechanism
        Bodies, joints and springs.
    until
        End [s].
    step
        Length of a slab [s], shortened to divide the duration evenly.
    every
        Slabs between two steps that are yielded.
    state
        State of an earlier march of the mechanism with the same ``until`` and ``step``, ``march_state()`` of one of its
        steps: the march continues from there, and yields only later states.

    Raises
    ------
    InputError
        Before the first step: for wrong input, or the state of another march.
    NumericsError
        If a slab has no solution at any length.

    Examples
    --------
    >>> from softway.mechanisms import Mechanism, Rigid, Rod
    >>> mass = Rigid(mass=1.0, centre=(1.0, 0.0))
    >>> rod = Rod(between=("ground", "mass"), ends=((0.0, 0.0), (1.0, 0.0)))
    >>> pendulum = Mechanism(bodies={"mass": mass}, joints={"rod": rod}, gravity=(0.0, -9.81))
    >>> last = list(march(pendulum, until=1.0, step=0.01))[-1]
    >>> abs(last.energy_error) < 1e-12, abs(float(np.hypot(*last.bodies["mass"].centre)) - 1.0) < 1e-13
    (True, True)
    """
    groups = march_groups(mechanism, until=until, step=step, every=every, state=state)
    return (one for group in groups for one in group.steps())


def march_groups(
    mechanism: Mechanism, *, until: Second, step: Second, every: int = 1, state: MechanismState | None = None
) -> Iterator[MechanismGroup]:
    """March a mechanism as :func:`march`; yields its states in groups of those that were compiled together."""
    mechanism.require_cold()
    if not (np.isfinite(until) and until > 0.0):
        raise InputError("until", f"{until:g} s is not positive", "a time after the start")
    if not (np.isfinite(step) and 0.0 < step <= until):
        raise InputError("step", f"{step:g} s is not positive, or longer than the march", f"at most {until:g} s")
    if every < 1:
        raise InputError("every", f"{every}", "1 or more")
    if not until / step < MOST:
        raise InputError("step", f"{until / step:.3g} slabs of {step:.3g} s", "an earlier end, or longer slabs")
    return walk_of(mechanism, until, step, every, state).groups()
