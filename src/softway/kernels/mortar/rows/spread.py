"""Terms of the vertices of a surface, added to those of their nodes in a row."""

from softway.kernels.jit.compilation import uncounted

CROSS = 1
"""First of the terms of a node that its vertices have: the motion of the master, and after it the slopes."""


@uncounted
def spread_terms(surface, vertex, room):
    """Add the terms of a vertex, the motion of the master and the slopes, to those of its nodes."""
    for q in range(surface.start[vertex], surface.start[vertex + 1]):
        column = surface.column[q]
        list_node(column, room)
        for c in range(len(room.terms)):
            room.sums[column, CROSS + c] += surface.value[q] * room.terms[c]


@uncounted
def list_node(column, room):
    """Add a node to the list of the row."""
    if not room.used[column]:
        room.used[column], room.listed[room.number[0]] = True, column
        room.number[0] += 1
