"""Cells whose facets are of a kind, for surfaces of each kind."""

SOLIDS = {
    "bar2": "quad4",
    "bar3": "quad9",
    "tri3": "tet4",
    "tri6": "tet10",
    "quad4": "hex8",
    "quad8": "hex20",
    "quad9": "hex27",
}
"""Cell by the kind of its facets."""
PLANE = ("bar2", "bar3")
"""Kinds of facets in the plane."""
