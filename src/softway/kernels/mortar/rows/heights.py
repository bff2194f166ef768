"""Heights of curved surfaces in the rows of mortar contact, and their slopes along the master.

A height is a quadratic form of barycentric coordinates (``contact/mortar/curved_surface.py``).
"""

from softway.kernels.jit.compilation import uncounted

COARSE = 4.0
"""Greatest bow of the master over a slave simplex, relative to that over its own, which is taken for its curvature."""


@uncounted
def add_heights(slave, master, heights, pairs, below, above, i, s, cosine, room, out):
    """Write the integrals ``out[s]`` (k,) of the coordinates on the slave simplex i and the heights of both surfaces.

    The heights at the corners of the slave are interpolated linearly: what this leaves out, the curvature of the one
    surface relative to the other, would shift the distance at the node that the dual functions read from the mean.
    Where the master curves on a much smaller scale than the slave's, its heights on the overlap count instead.
    """
    own, other = heights
    j, k = pairs.master[s], len(room.at)
    fine = _kept(slave, other, below, i, j, room)
    for b in range(k):
        room.rise[b] = _opposite(slave, master, other, below, above, i, j, b, cosine, room)
        if slave.corner[i, b] < slave.centre:
            room.rise[b] += own[i, b, b]
    for a in range(k):
        linear = covered = 0.0
        for b in range(k):
            linear += pairs.own[s, a, b] * room.rise[b]
            covered += pairs.own[s, a, b]
        out[s, a] = fine * linear
        if fine < 1.0 and covered > 0.0:
            for b in range(k):
                room.at[b] = pairs.cross[s, a, b] / covered
            local = _height(other, j, room.at) / cosine
            for b in range(k):
                room.at[b] = pairs.own[s, a, b] / covered
            local += _height(own, i, room.at)
            out[s, a] += (1.0 - fine) * covered * local


@uncounted
def tilt(form, j, weight, cosine, room, facing):
    """Tilt the slope ``facing`` (d,) of a distance by the slope of the height above the master simplex j.

    The latter is taken at the mean of the master's coordinates with the weights ``weight`` (k,). A motion along the
    distance stays as it is: only the slip along the master counts.
    """
    total = across = 0.0
    for b in range(len(weight)):
        total += weight[b]
    for b in range(len(weight)):
        room.at[b] = 0.0
        for c in range(len(weight)):
            room.at[b] += 2.0 * form[j, b, c] * weight[c] / total if total > 0.0 else 0.0
        for x in range(len(facing)):
            across -= room.at[b] * room.along[b, x] * room.square[0, x]
    for x in range(len(facing)):
        slope = 0.0
        for b in range(len(weight)):
            slope += room.at[b] * room.along[b, x]
        facing[x] += (across * room.normal[0, x] / cosine - slope) / cosine


@uncounted
def _height(form, p, at):
    """Height above the simplex p at barycentric coordinates ``at`` (k,)."""
    total = 0.0
    for a in range(len(at)):
        for b in range(len(at)):
            total += form[p, a, b] * at[a] * at[b]
    return total


@uncounted
def _kept(slave, form, below, i, j, room):
    """Share of the curvature of a master that is left out over the whole slave: one unless it bows by far more over the
    slave than over itself.
    """
    k, over, own = len(room.at), 0.0, 0.0
    for a in range(k):
        for b in range(a):
            own = max(own, abs(2.0 * form[j, a, b] - form[j, a, a] - form[j, b, b]))
            for e in range(k):
                room.at[e] = 0.0
                for x in range(below.shape[1]):
                    step = below[slave.corner[i, a], x] - below[slave.corner[i, b], x]
                    room.at[e] += room.along[e, x] * step
            over = max(over, abs(_height(form, j, room.at)))
    return COARSE * own / over if over > COARSE * own else 1.0


@uncounted
def _opposite(slave, master, form, below, above, i, j, a, cosine, room):
    """Height of a master, along the distance, opposite to a corner of the slave.

    The centre of a four-node facet has the mean of its four corners: two of them are the mirror images of the others.
    """
    if slave.corner[i, a] < slave.centre:
        return _facing(slave, master, form, below, above, i, j, a, a, cosine, room)
    total = 0.0
    for b in range(2):
        total += _facing(slave, master, form, below, above, i, j, b, b, cosine, room)
        total += _facing(slave, master, form, below, above, i, j, b, a, cosine, room)
    return 0.25 * total


@uncounted
def _facing(slave, master, form, below, above, i, j, b, about, cosine, room):
    """Height of a master, along the distance, opposite to the mirror image of the corner b of the slave about another
    one: to the corner itself if this is the same.
    """
    one, other, base, away = slave.corner[i, b], slave.corner[i, about], master.corner[j, 0], 0.0
    for x in range(below.shape[1]):
        away += room.normal[0, x] * (2.0 * below[other, x] - below[one, x] - above[base, x])
    for e in range(len(room.at)):
        room.at[e] = 1.0 if e == 0 else 0.0
        for x in range(below.shape[1]):
            step = 2.0 * below[other, x] - below[one, x] - above[base, x] + away / cosine * room.square[0, x]
            room.at[e] += room.along[e, x] * step
    return _height(form, j, room.at) / cosine
