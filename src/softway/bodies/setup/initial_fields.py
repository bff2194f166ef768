"""Initial fields of displacement and velocity: a vector at every node.

Values are in [m] for displacements and in [m/s] for velocities.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.mesh import Mesh
from softway.units import Metre

PerMetre = Annotated[float, "*/m"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform:
    """Uniform vector field.

    Parameters
    ----------
    value
        Vector; a number in one dimension, or 0 in any dimension.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> sample(Uniform(value=-1.0), interval(1.0, cells=1)).tolist()
    [[-1.0], [-1.0]]
    """

    value: tuple[float, ...] | float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Affine:
    """Affine field ``value + gradient (X - origin)``.

    Parameters
    ----------
    value
        Vector at the origin.
    gradient
        Matrix; row i contains the derivatives of component i along x, y, z.  A number in one dimension.
    origin
        Point where the field has the value [m]; zero by default.

    Examples
    --------
    A bar stretched by one percent:

    >>> from softway.meshes.generators.shapes import interval
    >>> sample(Affine(gradient=0.01), interval(1.0, cells=1)).round(12).tolist()
    [[0.0], [0.01]]
    """

    value: tuple[float, ...] | float = 0.0
    gradient: tuple[tuple[PerMetre, ...], ...] | PerMetre = 0.0
    origin: tuple[Metre, ...] | Metre = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """Piecewise linear field along an axis, constant beyond the first and the last point.

    Parameters
    ----------
    axis
        ``x``, ``y`` or ``z``.
    at
        Increasing coordinates along the axis [m].
    values
        One value for each coordinate: vectors, or numbers for the component along the axis.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> sample(Profile(at=(0.0, 1.0), values=(0.0, 3.0)), interval(2.0, cells=4)).ravel().tolist()
    [0.0, 1.5, 3.0, 3.0, 3.0]
    """

    axis: str = "x"
    at: tuple[Metre, ...]
    values: tuple[float, ...] | tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class OnTag:
    """Vector at the nodes of a tag, zero elsewhere.

    Parameters
    ----------
    tag
        Tag of the nodes.
    value
        Vector; a number in one dimension.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> sample(OnTag(tag="right", value=2.0), interval(1.0, cells=1)).tolist()
    [[0.0], [2.0]]
    """

    tag: str
    value: tuple[float, ...] | float


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldSum:
    """Sum of fields.

    Parameters
    ----------
    terms
        Fields to add.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> sample(FieldSum(terms=(Uniform(value=1.0), OnTag(tag="left", value=1.0))), interval(1.0, cells=1)).tolist()
    [[2.0], [1.0]]
    """

    terms: tuple[Uniform | Affine | Profile | OnTag, ...]


Field = Uniform | Affine | Profile | OnTag | FieldSum


def sample(field: Field | Array | Callable[[Array], Array], mesh: Mesh) -> Array:
    """Nodal values (n, d) of a field.

    Parameters
    ----------
    field
        Field; from Python also one vector (d,), an array (n, d) of nodal values, or a function of the points (n, d)
        that returns either.
    mesh
        Mesh of the nodes.
    """
    match field:
        case Uniform():
            found = np.tile(components("value", field.value, mesh.dim), (mesh.n_nodes, 1))
        case Affine():
            found = _affine(field, mesh)
        case Profile():
            found = _profile(field, mesh)
        case OnTag():
            found = np.zeros_like(mesh.points)
            found[_tagged(mesh, field.tag)] = components("value", field.value, mesh.dim)
        case FieldSum():
            found = sum((sample(term, mesh) for term in field.terms), np.zeros_like(mesh.points))
        case _:
            found = np.array(field(mesh.points) if callable(field) else field, dtype=float)
            if found.shape == (mesh.dim,):
                found = np.tile(found, (mesh.n_nodes, 1))
    if found.shape != mesh.points.shape or not np.isfinite(found).all():
        raise InputError(
            "",
            f"values of shape {found.shape} or not finite",
            f"finite numbers of shape {mesh.points.shape}, or of shape ({mesh.dim},) for all nodes",
        )
    return found


def components(where: str, value: Sequence[float] | float, dim: int) -> Array:
    """Vector (d,) from its components; a number in one dimension, or 0 for the zero vector.

    Examples
    --------
    >>> components("value", 0.0, 3).tolist(), components("value", -1.0, 1).tolist()
    ([0.0, 0.0, 0.0], [-1.0])
    """
    vector = np.asarray(value, dtype=float)
    if vector.ndim == 0 and (dim == 1 or vector == 0.0):
        vector = np.full(dim, float(vector))
    if vector.shape != (dim,):
        given = (
            f"{value:g} is one number"
            if isinstance(value, float | int)
            else f"{list(value)} has {len(value)} components"
        )
        raise InputError(where, f"{given} in {dim} dimensions", f"{dim} components")
    if not np.isfinite(vector).all():
        raise InputError(where, f"{vector.tolist()} is not finite", "finite numbers")
    return vector


def _affine(field: Affine, mesh: Mesh) -> Array:
    d = mesh.dim
    rows = field.gradient if isinstance(field.gradient, tuple | list) else ()
    if len({np.size(row) for row in rows}) > 1:
        raise InputError("gradient", f"rows of {[np.size(row) for row in rows]} numbers", f"{d} rows of {d} numbers")
    gradient = np.asarray(field.gradient, dtype=float)
    if gradient.ndim == 0 and (d == 1 or gradient == 0.0):
        gradient = np.full((d, d), float(gradient))
    if gradient.shape != (d, d):
        raise InputError("gradient", f"numbers of shape {gradient.shape} in {d} dimensions", f"{d} rows of {d} numbers")
    arms = mesh.points - components("origin", field.origin, d)
    return np.asarray(components("value", field.value, d) + arms @ gradient.T)


def _profile(field: Profile, mesh: Mesh) -> Array:
    axis = {"x": 0, "y": 1, "z": 2}.get(field.axis, 3)
    if axis >= mesh.dim:
        raise InputError("axis", f"{field.axis!r} in {mesh.dim} dimensions", f"one of: {', '.join('xyz'[: mesh.dim])}")
    at = np.asarray(field.at, dtype=float)
    if len(at) == 0 or len(at) != len(field.values) or (np.diff(at) <= 0.0).any():
        raise InputError(
            "at", f"{list(field.at)} with {len(field.values)} values", "increasing coordinates, one for each value"
        )
    along = np.zeros(mesh.dim)
    along[axis] = 1.0
    values: Sequence[Sequence[float] | float] = field.values
    table = np.array(
        [
            along * value if isinstance(value, float | int) else components(f"values[{k}]", value, mesh.dim)
            for k, value in enumerate(values)
        ]
    )
    return np.column_stack([np.interp(mesh.points[:, axis], at, table[:, i]) for i in range(mesh.dim)])


def _tagged(mesh: Mesh, tag: str) -> IntArray:
    try:
        return mesh.nodes(tag)
    except InputError as error:
        raise error.within("tag") from None
