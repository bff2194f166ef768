"""Slabs (time steps) of a mechanism with stops of which none is touched, in one compiled loop."""

import numpy as np

from softway.kernels.jit.compilation import kernel
from softway.kernels.multibody.slab import evaluate_rows
from softway.kernels.rigid_contact.closed_stops import closed_rows, hold, jammed, take_contact_slab
from softway.kernels.rigid_contact.contact import solve_contact_slab
from softway.kernels.rigid_course.course import ITERATIONS, is_noted, note_state, reach

TOUCH = 1e-14
"""Gap relative to the extent that is rounding."""
FLOWN, CHANGED, REFUSED, LOST = range(4)
"""Ends of the loop: the group is complete; a stop has opened in the last slab; the next slab has a touch, sliding that
jams or has located instants, or no solution; the last slab has no velocities at its end."""


@kernel
def fly_rows(bodies, joints, springs, motion, space, stops, course, extent, h, first, total):
    """March the slabs ``first`` to ``total`` of a group: the number of the first that was not taken, and the end."""
    stays, none = np.zeros(len(stops.closed), np.bool_), np.zeros(len(stops.closed))
    for slab in range(first, total):
        row = slab // course.every
        scale = reach(motion.place, motion.velocity, bodies.gravity, extent, h)
        if _happens(joints, motion, space, stops):
            return slab, REFUSED
        used = _tried(bodies, joints, springs, motion, space, stops, h, scale)
        if used == 0:
            return slab, REFUSED
        stops.spent[:], stops.shut[:] = 0.0, 0.0
        told = course.told[row]
        if not take_contact_slab(bodies, joints, springs, motion, space, stops, h, scale, told, none, stays):
            return slab, LOST
        opened = (stays != stops.closed).any()
        stops.closed[:] = stays
        hold(bodies, joints, stops)
        course.counts[row, ITERATIONS] += used
        if is_noted(course, slab, total):
            note_stops(bodies, joints, springs, motion, space, stops, course, row)
        if opened:
            return slab + 1, CHANGED
    return total, FLOWN


@kernel
def note_stops(bodies, joints, springs, motion, space, stops, course, row):
    """Set a row of the course to the present state, with its closed stops."""
    note_state(bodies, joints, springs, motion, space, course, row)
    course.closed[row] = stops.closed


@kernel
def _happens(joints, motion, space, stops):
    """True if a closed stop slides with located instants, or jams."""
    return (stops.located & stops.closed).any() or jammed(joints, motion, space, stops).any()


@kernel
def try_slab(bodies, joints, springs, motion, space, stops, smooth, h, extent):
    """Solve a slab with the closed stops, without taking it; the number of iterations, 0 if it has no solution.

    Those that are ``smooth`` (s,) have no friction in it.
    """
    rows, friction = closed_rows(stops)
    c = 0
    for k in range(len(stops.closed)):
        if stops.closed[k]:
            if smooth[k]:
                friction[c] = 0.0
            c += 1
        else:
            for row in stops.rows[k]:
                motion.impulse[row] = 0.0
    return solve_contact_slab(bodies, joints, springs, motion, space, rows, friction, h, extent)


@kernel
def _tried(bodies, joints, springs, motion, space, stops, h, extent):
    """Solve a slab; the iterations, or 0 and the state as before if it has no solution or touches an open stop."""
    smooth = np.zeros(len(stops.closed), np.bool_)
    used = try_slab(bodies, joints, springs, motion, space, stops, smooth, h, extent)
    touched = False
    for k in range(len(stops.closed)):
        touched = touched or (not stops.closed[k] and space.g[stops.rows[k, 0]] < -TOUCH * extent)
    if used == 0 or touched:
        motion.impulse[:] = space.kept
        evaluate_rows(joints, motion, space, motion.place, space.R0)
        return 0
    return used
