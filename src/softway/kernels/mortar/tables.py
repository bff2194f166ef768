"""Arrays of two surfaces of simplices for the compiled loops of mortar contact."""

from typing import NamedTuple

from softway.arrays import Array, BoolArray, IntArray


class Vertices(NamedTuple):
    """Vertices of a surface from its nodes, and its simplices.

    Vertex v is the sum of the nodes ``column`` with the factors ``value`` between ``start[v]`` and ``start[v + 1]``;
    ``corner`` (p, k) are the vertices of the simplices; from ``centre`` on they are centres of four-node facets.
    """

    start: IntArray
    column: IntArray
    value: Array
    corner: IntArray
    centre: int


class Facets(NamedTuple):
    """Facets of the slave, with their test functions.

    ``cells`` (f, b) are control points, which are the first vertices, -1 where a facet has fewer than b; the simplices
    of a facet are ``simplex[f]`` to ``simplex[f + 1]``.  The test function of a row is the sum of the functions
    ``place`` of the facets ``facet`` with the factors ``share``, between ``start[r]`` and ``start[r + 1]``.
    """

    cells: IntArray
    simplex: IntArray
    start: IntArray
    facet: IntArray
    place: IntArray
    share: Array


class Functions(NamedTuple):
    """Test functions: ``values`` (p, b, k) at the corners of the simplices, and ``own`` (f, b, b): integrals with the
    shape functions of the facets over the covered parts [m^r].
    """

    values: Array
    own: Array


class Pairs(NamedTuple):
    """Pairs of simplices that overlap: those of a slave simplex are ``first[p]`` to ``first[p + 1]``, with the master
    simplices ``master`` (s,) and the integrals ``own`` and ``cross`` (s, k, k) of products of coordinates [m^r], with
    the weights of the pairs; ``change`` (s,) is the change of the weight with the cosine of the angle between the
    surfaces, relative to the weight.
    """

    first: IntArray
    master: IntArray
    own: Array
    cross: Array
    change: Array


class Distances(NamedTuple):
    """Distance of the surfaces of the pairs: slopes ``facing`` (s, k, d) under a shift of the slave, for each of its
    coordinates, or (s, 1, d) for all where surfaces are flat; integrals ``span`` (s, k) of coordinates and the distance
    of the simplices, and ``height`` (s, k) of coordinates and the heights of both surfaces along it [m^(r+1)], and
    integrals ``leaning`` (p, k, k, d) of coordinates on the
    slave and the slopes under a motion of its corners [m^r].
    """

    facing: Array
    span: Array
    height: Array
    leaning: Array


class Fading(NamedTuple):
    """Pairs whose weights change: the ``number`` (s,) of each pair among them, -1 where the weight does not change, and
    the changes under a motion of the corners, relative to the weight, ``slave`` and ``master`` (f, k, d) [1/m].  Beside
    them the vertices ``points`` (v, d) of the slave [m], and the length or area ``size`` (p,) of its simplices [m^r].
    """

    number: IntArray
    slave: Array
    master: Array
    points: Array
    size: Array


class FacetSums(NamedTuple):
    """Place for one facet of up to b nodes: integrals ``mass`` (b, b) of its shape functions and their ``inverse``,
    integrals ``apart`` (b,) of the shape functions and a distance, their product ``dual`` (1, b) with the inverse, the
    warping ``warp`` (4,), and the numbers ``known`` (4,).
    """

    mass: Array
    inverse: Array
    apart: Array
    dual: Array
    warp: Array
    known: Array


class Entries(NamedTuple):
    """Sparse weights (m, n) and slopes (m, n d): entries of the row r are ``first[r]`` to ``first[r + 1]`` of
    ``column`` and ``weight``, and ``start[r]`` to ``start[r + 1]`` of ``component`` and ``slope``.
    """

    first: IntArray
    column: IntArray
    weight: Array
    start: IntArray
    component: IntArray
    slope: Array


class Room(NamedTuple):
    """Sums of one row: terms ``sums`` (u, 2 + d) of the nodes, ``used`` (u,) nodes and the list ``listed`` of them;
    terms ``held`` (w, 1 + d) of the vertices of the master, the ``seen`` ones (w,) and the list ``opposite`` of them;
    the lengths ``number`` (2,) of both lists, the sums ``mean`` (d,) of the normals and ``height`` (1,) of the heights,
    ``terms`` (1 + d,) of a vertex, and those of a ``facet``.
    """

    sums: Array
    used: BoolArray
    listed: IntArray
    held: Array
    seen: BoolArray
    opposite: IntArray
    number: IntArray
    mean: Array
    height: Array
    terms: Array
    facet: FacetSums
