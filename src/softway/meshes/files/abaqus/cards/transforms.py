"""Systems of coordinates, rotations and reflections of an input deck."""

import numpy as np

from softway.arrays import Array


def cartesian(place: tuple[float, float, float], system: str) -> Array:
    """Rectangular coordinates (3,) of a point in system R (x, y, z), C (r, angle, z) or S (r, angle, elevation).

    The angles are in degrees: the first one is measured from the x axis in the plane z = 0, the elevation from this
    plane.

    Examples
    --------
    >>> cartesian((2.0, 90.0, 1.0), "C").round(12).tolist()
    [0.0, 2.0, 1.0]
    >>> cartesian((2.0, 0.0, 90.0), "S").round(12).tolist()
    [0.0, 0.0, 2.0]
    """
    r, second, third = place
    if system == "R":
        return np.array(place)
    radius, z = r, third
    if system == "S":
        radius, z = r * np.cos(np.radians(third)), r * np.sin(np.radians(third))
    return np.array([radius * np.cos(np.radians(second)), radius * np.sin(np.radians(second)), z])


def frame(origin: Array, b: Array | None, c: Array | None) -> Array:
    """Axes (3, 3), as columns, of a system with ``b`` on the first axis and ``c`` in the plane of the first two.

    Without ``c`` the third axis is z, and without ``b`` the axes are not turned.

    Raises
    ------
    ValueError
        If the points do not define axes.

    Examples
    --------
    >>> frame(np.zeros(3), np.array([0.0, 1.0, 0.0]), None).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    if b is None:
        return np.eye(3)
    first = (b - origin) * ([1.0, 1.0, 0.0] if c is None else 1.0)
    normal = np.array([0.0, 0.0, 1.0]) if c is None else np.cross(first, c - origin)
    sizes = np.linalg.norm(first), np.linalg.norm(normal)
    if not (sizes[0] > 0.0 and sizes[1] > 1e-12 * sizes[0] * (1.0 if c is None else np.linalg.norm(c - origin))):
        raise ValueError("the points of the system are on one line")
    x, z = first / sizes[0], normal / sizes[1]
    return np.column_stack([x, np.cross(z, x), z]) + 0.0


def rotated(points: Array, a: Array, b: Array, degrees: float) -> Array:
    """Points (n, 3) turned about the axis from ``a`` to ``b`` by an angle [degrees].

    Examples
    --------
    >>> rotated(np.array([[1.0, 0.0, 0.0]]), np.zeros(3), np.array([0.0, 0.0, 2.0]), 90.0).round(12).tolist()
    [[0.0, 1.0, 0.0]]
    """
    length = np.linalg.norm(b - a)
    if degrees == 0.0 or length == 0.0:
        return points
    k, angle, x = (b - a) / length, np.radians(degrees), points - a
    turned: Array = x * np.cos(angle) + np.cross(k, x) * np.sin(angle) + np.outer(x @ k, k) * (1.0 - np.cos(angle))
    return turned + a


def mirrored(points: Array, about: str, given: list[Array]) -> Array:
    """Points (n, 3) reflected about a point, a line through two points, or a plane through three points.

    Raises
    ------
    ValueError
        For another kind of reflection, or if the points do not define the line or the plane.

    Examples
    --------
    >>> plane = [np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])]
    >>> mirrored(np.array([[2.0, 3.0, 4.0]]), "MIRROR", plane).tolist()
    [[-2.0, 3.0, 4.0]]
    """
    a, b, c = given
    x = points - a
    if about == "POINT":
        return a - x + 0.0
    axis = b - a if about == "LINE" else np.cross(b - a, c - a)
    size = np.linalg.norm(axis)
    if about not in ("LINE", "MIRROR") or not size > 0.0:
        raise ValueError(f"REFLECT={about:.20} with these points defines no reflection")
    k = axis / size
    across = np.outer(x @ k, k)
    return (2.0 * across - x if about == "LINE" else x - 2.0 * across) + a + 0.0
