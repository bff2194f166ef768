"""Rigid-body modes that supports leave free; a static start must have none."""

from collections.abc import Callable, Sequence

import numpy as np

from softway.arrays import Array

_TOLERANCE = 1e-9


def rigid_motions(points: Array, names: Sequence[str], centre: Array) -> tuple[Array, tuple[str, ...]]:
    """Displacements (n d, m) of rigid motions given by name, about ``centre`` (d,) and of comparable size.

    Examples
    --------
    >>> rigid_motions(np.array([[0.0], [1.0]]), ["translation along x"], np.zeros(1))[0].ravel()
    array([1., 1.])
    """
    n, dim = points.shape
    arm = np.zeros((n, 3))
    arm[:, :dim] = points - centre
    size = max(float(np.abs(arm).max()), np.finfo(float).tiny)
    columns = []
    for name in names:
        unit = np.eye(3)["xyz".index(name[-1])]
        field = np.cross(unit, arm) / size if name.startswith("rotation") else np.tile(unit, (n, 1))
        columns.append(field[:, :dim].ravel())
    return np.array(columns).T, tuple(names)


def motion_names(dim: int, axisymmetric: bool) -> tuple[str, ...]:
    """Names of the rigid motions of a body in ``dim`` dimensions.

    Examples
    --------
    >>> motion_names(2, axisymmetric=False)
    ('translation along x', 'translation along y', 'rotation about z')
    """
    if axisymmetric:
        return ("translation along y",)
    shifts = tuple(f"translation along {a}" for a in "xyz"[:dim])
    turns = {1: "", 2: "z", 3: "xyz"}[dim]
    return shifts + tuple(f"rotation about {a}" for a in turns)


HeldParts = Callable[[Array], Array]
"""Parts (n, d) of a field (n, d) that supports hold."""


def free_motions(points: Array, held: HeldParts, axisymmetric: bool = False) -> tuple[str, ...]:
    """Names of the rigid motions that the supports leave free.

    Parameters
    ----------
    points
        (n, d) nodes [m].
    held
        Parts of a field that the supports hold.
    axisymmetric
        True for a body of revolution, with the translation along its axis as the only rigid motion.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    >>> pinned = np.array([[True, True], [False, False], [False, False], [False, False]])
    >>> free_motions(square, lambda field: field * pinned)
    ('rotation about z',)
    """
    supported = np.any([held(np.tile(axis, (len(points), 1))) for axis in np.eye(points.shape[1])], axis=(0, 2))
    centre = points[supported].mean(axis=0) if supported.any() else points.mean(axis=0)
    modes, names = rigid_motions(points, motion_names(points.shape[1], axisymmetric), centre)
    moving = np.linalg.norm(modes, axis=0) > _TOLERANCE * np.linalg.norm(modes)
    modes, names = modes[:, moving], tuple(n for n, m in zip(names, moving, strict=True) if m)
    rows = np.stack([held(mode.reshape(points.shape)).ravel() for mode in modes.T], axis=1)
    rows = rows[rows.any(axis=1)]
    _, values, right = np.linalg.svd(rows, full_matrices=True)
    rank = int((values > _TOLERANCE * max(1.0, values.max(initial=0.0))).sum())
    free = right[rank:]
    if not len(free):
        return ()
    share = np.linalg.norm(free, axis=0)
    pure = tuple(n for n, s in zip(names, share, strict=True) if s > 1.0 - 1e-6)
    mixed = tuple(n for n, s in zip(names, share, strict=True) if 1e-6 < s <= 1.0 - 1e-6)
    return pure if len(pure) == len(free) else (*pure, "a motion made of " + " and ".join(mixed))
