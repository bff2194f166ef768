"""Mesh of a solid for the coming slabs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.marking.indicator import indicator, wanted_levels, warmth_indicator
from softway.adaptivity.marking.neighbourhood import Mark, grown_near, marks_of
from softway.adaptivity.transfer import Motion
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.leaves import same
from softway.meshes.adaptive.refinement import AdaptedMesh, adapted_mesh
from softway.meshes.adaptive.tree import Tree, tree_of
from softway.meshes.mesh import Mesh

SOON = 1.0
"""Greatest way in a requested slab, relative to the allowed approach to cells that ``auto`` makes finer than now."""
LATE = 8.0
"""The same to cells that are there."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Wanted:
    """Cells of a solid for the coming slabs, without a buffer around fine ones.

    Parameters
    ----------
    adapt
        Adaption of the solid.
    present
        Its mesh.
    tree
        The cells.
    fine
        The same without cells that become coarser by two cuts: what has a buffer.  Conforming meshes have fine cells
        far from where they are wanted, in space above all; with buffers around those they would grow from change to
        change.
    group
        Number of the group of linked solids.
    """

    adapt: Adapt
    present: AdaptedMesh
    tree: Tree
    fine: Tree
    group: int

    @property
    def deepest(self) -> int:
        """Level of the finest cells."""
        return self.adapt.deepest(self.tree.base.cell_dim)

    def mesh(self, linked: Sequence["Wanted"], stretch: float = 1.0) -> AdaptedMesh:
        """Mesh with a buffer around the fine cells of the solid and of those that are ``linked`` with it: waves pass
        through ties.  The coming slabs have the length of ``stretch`` requested ones: fronts go as much further.
        """
        marks: list[Mark] = marks_of(self.fine)
        for other in linked:
            marks += [(self.deepest - other.deepest + level, places) for level, places in marks_of(other.fine)]
        tree = grown_near(self.tree, marks, stretch * self.adapt.buffer * self.adapt.finest(self.tree.base))
        return self.present if same(tree.leaves, self.present.leaves) else adapted_mesh(tree)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Seen:
    """What the indicators see of a solid of n nodes.

    Parameters
    ----------
    motion
        Its motion.
    warmth
        (n,) temperatures, relative to their range; None without.
    moves
        False without inertia.
    """

    motion: Motion
    warmth: Array | None = None
    moves: bool = True


def wanted_cells(
    adapt: Adapt, solid: AdaptedSolid, seen: Seen, energy: float, marks: Sequence[Mark], group: int = 0
) -> Wanted:
    """Cells of a solid for the coming slabs.

    Parameters
    ----------
    adapt
        Adaption of the solid.
    solid, seen
        The solid, its motion and temperature on the present mesh.
    energy
        Energy of the scene [J].
    marks
        Levels, at most the deepest, around places on the facets of the base mesh: of nodes at contacts that are closed
        or close soon, and near ones at a curved boundary.
    group
        Number of its group of linked solids.
    """
    base = solid.adapted.base
    finest, deepest = adapt.finest(base), adapt.deepest(base.cell_dim)
    stressed = indicator(solid, seen.motion, seen.moves)
    levels = wanted_levels(solid.adapted, stressed, adapt.threshold(base, energy), deepest)
    if seen.warmth is not None:
        bent = warmth_indicator(solid, seen.warmth)
        levels = np.maximum(levels, wanted_levels(solid.adapted, bent, adapt.threshold(base, 1.0), deepest))
    leaves, contact = solid.adapted.leaves, [(min(level, deepest), at) for level, at in marks]
    kept = np.where(levels >= leaves.level - solid.adapted.step, levels, 0)
    grown = (
        grown_near(tree_of(base).grown(leaves, wanted), contact, adapt.contact_cells * finest)
        for wanted in ((levels,) if np.array_equal(kept, levels) else (levels, kept))
    )
    tree, *others = grown
    fine = others[0] if others else tree
    return Wanted(adapt=adapt, present=solid.adapted, tree=tree, fine=fine, group=group)


def affordable(how: Adapt, present: AdaptedMesh) -> Adapt:
    """Adaption with which the coming mesh of a solid may have few enough cells.

    Only where there is room for another halving everywhere edges are halved once more than they are, so that meshes
    with about the greatest number of cells do not change to and fro.

    Examples
    --------
    >>> import numpy as np
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import rectangle
    >>> base = rectangle((1.0, 1.0), (60, 60))
    >>> [affordable(Adapt(), refined(base, np.full(3600, level))).deepest(2) for level in (0, 2)]
    [4, 2]
    """
    base, dim = present.base, present.base.cell_dim
    if present.mesh.n_cells * 2**dim <= how.most(base):
        return how
    return shallower(how, base, how.deepest(dim) // dim - max(1, ceil(present.leaves.level.max() / dim)))


def shallower(how: Adapt, base: Mesh, times: int = 1) -> Adapt:
    """Adaption that halves edges so many times less."""
    return replace(how, levels=max(0, how.deepest(base.cell_dim) - times * base.cell_dim))


def unhurried(how: Adapt, present: AdaptedMesh, way: float) -> Adapt:
    """Adaption of ``auto`` whose cells make slabs at a contact hardly shorter than requested.

    Surfaces approach by a part of an edge in a slab only, so that cells that are small against the way in a requested
    slab make slabs short.  Cells become finer than they are only where requested slabs suffice.  Those that are there
    stay while an eighth of it does: coarser ones would change the force of the contact, and change to and fro with the
    speed of its surfaces.

    Parameters
    ----------
    how, present
        The adaption, and the present mesh.
    way
        Greatest way towards contacts in a requested slab, relative to the allowed approach in edges [m].

    Examples
    --------
    >>> import numpy as np
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import interval
    >>> bar = interval(1.0, cells=4)
    >>> [unhurried(Adapt(), refined(bar, np.full(4, k)), 0.2).deepest(1) for k in (0, 1, 2)]
    [0, 1, 2]
    """
    base, dim = present.base, present.base.cell_dim
    now = int(present.leaves.level.max()) // dim
    while (times := how.deepest(dim) // dim) > 0:
        if way <= (LATE if times <= now else SOON) * how.finest(base):
            break
        how = shallower(how, base)
    return how
