"""Islands: groups of balls that contacts connect, each solved by itself."""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel


@inlined
def _root(parent, i):
    """First ball of a group; ways to it are shortened."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@kernel
def islands(pairs, n):
    """Pairs in the order of the islands, starts (i + 1,) of islands in it, balls of islands, and their starts."""
    parent = np.arange(n)
    for k in range(len(pairs)):
        if pairs[k, 1] < n:
            a, b = _root(parent, pairs[k, 0]), _root(parent, pairs[k, 1])
            parent[max(a, b)] = min(a, b)
    number, count = np.full(n, -1, np.int64), 0
    of_pair, of_ball = np.empty(len(pairs), np.int64), np.empty(n, np.int64)
    for k in range(len(pairs)):
        a = _root(parent, pairs[k, 0])
        if number[a] < 0:
            number[a] = count
            count += 1
        of_pair[k] = number[a]
    for i in range(n):
        of_ball[i] = number[_root(parent, i)]
    order, start = _sorted(of_pair, count)
    bodies, body_start = _sorted(of_ball, count)
    return pairs[order], start, bodies, body_start


@kernel
def _sorted(group, count):
    """Members of the groups, one group after the other, and starts (count + 1,); members of group -1 are left out."""
    start = np.zeros(count + 1, np.int64)
    for k in range(len(group)):
        if group[k] >= 0:
            start[group[k] + 1] += 1
    for i in range(count):
        start[i + 1] += start[i]
    order, fill = np.empty(start[count], np.int64), start[:-1].copy()
    for k in range(len(group)):
        if group[k] >= 0:
            order[fill[group[k]]] = k
            fill[group[k]] += 1
    return order, start
