"""Meshes with other cells for the present shape of a solid: boundary spaced anew, triangles and tetrahedra inside."""
