"""Memory of the matter on a mesh that replaces another one, with the present shape as its reference."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from softway.adaptivity.unrelated.control_volumes import ControlVolumes, control_volumes
from softway.adaptivity.unrelated.overlap import Overlap, overlap
from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, Volume
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce
from softway.bodies.internal_force.material_state import MaterialState
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.objective_rates import Jaumann, Truesdell

SECTIONS = Axisymmetric, PlaneStrain, Volume
"""Sections whose faces outside the plane do not move."""
RATES = Jaumann, Truesdell
"""Objective rates that do not know the deformation since the start."""

PASSING = "viscous", "temperature", "warming", "stiffness", "stiffening"
"""Arrays that only some laws need, whose means pass."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Recast:
    """Means over the points of a new mesh from those over the points of the old one.

    Parameters
    ----------
    old, new
        Control volumes.
    found
        Their overlap.
    before, after
        (p,) and (q,) present volumes of the points [m^3].
    nodes
        Number of nodes of the new mesh.
    """

    old: ControlVolumes
    new: ControlVolumes
    found: Overlap
    before: Array
    after: Array
    nodes: int

    def of(self, values: Array) -> Array:
        """Values (q, ...) at the new points from those (p, ...) at the old ones."""
        return self._cast(values).reshape(len(self.after), *values.shape[1:])

    def totals(self, values: Array) -> Array:
        """Values (q,) at the new points of a density with the integral before: by a factor where it is nowhere
        negative, by a shift otherwise.
        """
        cast, total = self._cast(values[:, None])[:, 0], float(self.before @ values)
        if (values >= 0.0).all():
            cast = np.maximum(cast, 0.0)
            now = float(self.after @ cast)
            return np.asarray(cast * (total / now)) if now > 0.0 else cast
        return np.asarray(cast + (total - float(self.after @ cast)) / float(self.after.sum()))

    def _cast(self, values: Array) -> Array:
        count, flat = len(self.old.whole), values.reshape(len(values), -1)
        means = np.zeros((count, flat.shape[1]))
        np.add.at(means, self.old.point, self.before[:, None] * flat)
        means /= np.bincount(self.old.point, self.before, minlength=count)[:, None]
        return self.found.means(means)[self.new.point]


def require_recast(part: DiscreteSolid) -> None:
    """Refuse a solid whose memory does not pass to a mesh with the present shape as its reference.

    Raises
    ------
    InputError
        For laws that store energy by the deformation since the start, or know it, several materials, and sections with
        a free thickness.
    """
    internal = part.internal
    remedy = "J2, Hypoelastic or NortonHoff with rate = Jaumann() or Truesdell(), one for the body"
    if not isinstance(internal, InelasticForce):
        law = "several laws" if part.materials.owner is not None else type(part.materials.laws[0]).__name__
        raise InputError("material", f"{law}: the stress depends on the undeformed shape, which is lost", remedy)
    if not isinstance(internal.material.rate, RATES):
        problem = f"rate {type(internal.material.rate).__name__}, which knows the deformation since the start"
        raise InputError("material.rate", problem, remedy)
    if not isinstance(internal.section, SECTIONS):
        problem = f"{type(internal.section).__name__}, whose thickness changes from place to place"
        raise InputError("section", problem, "PlaneStrain, Axisymmetric or Volume")


def present_volumes(part: DiscreteSolid, displacement: Array) -> Array:
    """Present volumes (p,) of the points of a solid at a displacement (n, d) [m^3]."""
    internal = part.internal
    assert isinstance(internal, InelasticForce)
    sampling = internal.sampling
    F = internal.points.gradient(sampling.plain_derivatives(displacement), internal.state.lateral)
    return np.asarray(tensors.determinant(F) * sampling.volume)


def recast(before: DiscreteSolid, displacement: Array, after: DiscreteSolid) -> Recast:
    """Transfer from a solid with a displacement (n, d) [m] to one on a mesh of its present shape."""
    old = _volumes(before, before.mesh.points + displacement)
    new = _volumes(after, after.mesh.points)
    radial = isinstance(after.internal.section, Axisymmetric)
    return Recast(
        old=old,
        new=new,
        found=overlap(old, new, radial=radial),
        before=present_volumes(before, displacement),
        after=np.asarray(after.internal.sampling.volume),
        nodes=after.mesh.n_nodes,
    )


def _volumes(part: DiscreteSolid, places: Array) -> ControlVolumes:
    cells: dict[str, IntArray] = dict(part.mesh.blocks)
    points = len(part.internal.sampling.volume) // part.mesh.n_cells
    return control_volumes(cells, places, dict.fromkeys(cells, points))


def recast_state(cast: Recast, state: MaterialState, reference: Array) -> MaterialState:
    """Material state on the new mesh, whose displacement is zero: stress and history variables by means, energies by
    sums.

    Parameters
    ----------
    cast
        Transfer.
    state
        Material state on the old mesh.
    reference
        (p,) reference volumes of the old points, which energies belong to [m^3].
    """
    share = reference / cast.before
    nodes = cast.nodes, state.displacement.shape[1]
    known = {name: values for name in PASSING if (values := getattr(state, name)) is not None}
    optional: dict[str, Any] = {name: cast.of(values) for name, values in known.items()}
    return replace(
        state,
        displacement=np.zeros(nodes),
        stress=cast.of(state.stress),
        law={name: _bounded(cast.of(values), values) for name, values in state.law.items()},
        lateral=np.ones((len(cast.after), state.lateral.shape[1])),
        stored=cast.totals(state.stored * share),
        dissipated=cast.totals(state.dissipated * share),
        **optional,
    )


def _bounded(values: Array, old: Array) -> Array:
    """Values within the bounds of the old ones, from which rounding may have moved them."""
    return np.asarray(np.clip(values, old.min(axis=0), old.max(axis=0)))
