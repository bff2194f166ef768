"""Memory of the matter on a mesh that replaces another one, with the present shape as its reference."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from softway.adaptivity.rezoning.zones import chosen
from softway.adaptivity.unrelated.control_volumes import ControlVolumes, control_volumes
from softway.adaptivity.unrelated.overlap import Overlap, overlap
from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, Volume
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce
from softway.bodies.internal_force.material_state import MaterialState, regional_history
from softway.bodies.internal_force.regions import RegionForces, Term
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.law import RateLaw
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
        For laws that store energy by the deformation since the start, or know it, and sections with a free thickness.
    """
    internal = part.internal
    remedy = "J2, Hypoelastic or NortonHoff with rate = Jaumann() or Truesdell()"
    for region, law in zip(part.materials.regions, part.materials.laws, strict=True):
        where = f"material.{region}" if region else "material"
        if not isinstance(law, RateLaw):
            problem = f"{type(law).__name__}: the stress depends on the undeformed shape, which is lost"
            raise InputError(where, problem, remedy)
        if not isinstance(law.rate, RATES):
            problem = f"rate {type(law.rate).__name__}, which knows the deformation since the start"
            raise InputError(f"{where}.rate", problem, remedy)
    if not isinstance(internal.section, SECTIONS):
        problem = f"{type(internal.section).__name__}, whose thickness changes from place to place"
        raise InputError("section", problem, "PlaneStrain, Axisymmetric or Volume")


def present_volumes(part: DiscreteSolid, displacement: Array) -> Array:
    """Present volumes (p,) of the points of a solid of one material at a displacement (n, d) [m^3]."""
    return _side(part, None, displacement).present()


def recast_memory(
    before: DiscreteSolid, displacement: Array, after: DiscreteSolid, state: MaterialState
) -> MaterialState:
    """Material state of a solid on a mesh of its present shape; each material has that of its own matter.

    Parameters
    ----------
    before, displacement
        The solid on the old mesh, with a displacement (n, d) [m].
    after
        The solid on the new mesh.
    state
        Material state on the old mesh.
    """
    old, new = before.internal, after.internal
    if not (isinstance(old, RegionForces) and isinstance(new, RegionForces)):
        return recast_state(recast(before, displacement, after), state, np.asarray(old.sampling.volume))
    terms, regions = {term.region: term for term in old.terms}, {}
    for term in new.terms:
        was = terms[term.region]
        sides = _side(before, was, displacement), _side(after, term, np.zeros_like(after.mesh.points))
        regions[term.region] = recast_state(_recast(*sides), state.regions[term.region], was.internal.sampling.volume)
    return regional_history(np.zeros_like(after.mesh.points), regions, 0.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Side:
    """Cells of one law with places (n, d) of their nodes and displacements (k, d) of those of the ``internal`` force
    [m].
    """

    blocks: Mapping[str, IntArray]
    places: Array
    internal: BodyForce
    displacement: Array

    def volumes(self) -> ControlVolumes:
        """Control volumes of the points."""
        counts = (rows.shape[1] for rows in self.internal.sampling.rows)
        return control_volumes(self.blocks, self.places, dict(zip(self.blocks, counts, strict=True)))

    def present(self) -> Array:
        """Present volumes (p,) of the points [m^3]."""
        internal = self.internal
        assert isinstance(internal, InelasticForce)
        sampling = internal.sampling
        F = internal.points.gradient(sampling.plain_derivatives(self.displacement), internal.state.lateral)
        return np.asarray(tensors.determinant(F) * sampling.volume)


def _side(part: DiscreteSolid, term: Term | None, displacement: Array) -> _Side:
    """Cells of a region of a solid at a displacement (n, d); all for None."""
    blocks, internal, own = dict(part.mesh.blocks), part.internal, displacement
    if term is not None:
        mine = np.isin(np.arange(part.mesh.n_cells), term.cells)
        blocks, internal, own = chosen(blocks, mine), term.internal, displacement[term.nodes]
    return _Side(blocks=blocks, places=part.mesh.points + displacement, internal=internal, displacement=own)


def recast(before: DiscreteSolid, displacement: Array, after: DiscreteSolid) -> Recast:
    """Transfer from a solid of one material with a displacement (n, d) [m] to one on a mesh of its present shape."""
    return _recast(_side(before, None, displacement), _side(after, None, np.zeros_like(after.mesh.points)))


def _recast(before: _Side, after: _Side) -> Recast:
    """Transfer between cells of one law."""
    old, new, radial = before.volumes(), after.volumes(), isinstance(after.internal.section, Axisymmetric)
    return Recast(
        old=old,
        new=new,
        found=overlap(old, new, radial=radial),
        before=before.present(),
        after=np.asarray(after.internal.sampling.volume),
        nodes=len(after.displacement),
    )


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
