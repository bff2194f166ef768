"""Work of the friction forces at the two ends of a slab (time step), and the energy that friction dissipates."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.contact_rows import ContactRows


@dataclass(frozen=True, slots=True, eq=False)
class FrictionWork:
    """Work of the tangential forces at the two ends over the slip of the slab, for each group of touching bodies.

    Parameters
    ----------
    first
        (groups,) work of the forces at the start [J]; positive where they drive the slip, which has turned.
    last
        (groups,) work of the forces at the end [J]; by every friction law not positive.

    Examples
    --------
    A slip that has turned: the force at the start drives it with 3 J, the force at the end takes 1 J.

    >>> import numpy as np
    >>> work = FrictionWork(first=np.array([3.0]), last=np.array([-1.0]))
    >>> work.dissipated(np.array([0.0]))
    array([-1.])
    """

    first: Array
    last: Array

    @property
    def slope(self) -> Array:
        """Derivative (groups,) of the dissipated energy with respect to the scalar [J]."""
        return self.first - self.last

    def dissipated(self, scalar: Array) -> Array:
        """Energy (groups,) that the mean forces with the ``scalar`` (groups,) dissipate [J]; negative if they create
        energy.
        """
        return -((0.5 - scalar) * self.first + (0.5 + scalar) * self.last)


def row_heats(
    ends: tuple[tuple[ContactRows, Array], tuple[ContactRows, Array]], moved: Array, group: IntArray
) -> Array:
    """Energy (m,) that friction dissipates at each row [J], nowhere negative.

    Its sum over a group is what the forces take in all, and zero where they would give energy; rows share it in
    proportion to the energy that they take.

    Parameters
    ----------
    ends
        Contact rows and tangential forces (m, d) [N] at the start and at the end, by their weights in the slab.
    moved
        (n, d) motion of the nodes over the slab [m].
    group
        (m,) number of the group of each row.
    """
    taken = -sum(np.einsum("md,md->m", force, rows.shear.slip(moved)) for rows, force in ends)
    rubbing = np.maximum(taken, 0.0)
    whole, positive = (np.bincount(group, weights=w) for w in (taken, rubbing))
    share = np.maximum(whole, 0.0) / np.where(positive > 0.0, positive, 1.0)
    return np.asarray(rubbing * share[group])


def friction_work(
    ends: tuple[tuple[ContactRows, Array], tuple[ContactRows, Array]], moved: Array, group: IntArray, groups: int
) -> FrictionWork:
    """Work of friction in each of so many ``groups``.

    Parameters
    ----------
    ends
        Contact rows and their tangential forces (m, d) [N] at the start and at the end.
    moved
        (n, d) motion of the nodes over the slab [m].
    group
        (m,) number of the group of each row.
    """
    if not ends[0][0].shear.count:
        return FrictionWork(np.zeros(groups), np.zeros(groups))
    works = [np.einsum("md,md->m", shear, rows.shear.slip(moved)) for rows, shear in ends]
    return FrictionWork(*(np.asarray(np.bincount(group, w, groups), float) for w in works))
