"""Curved boundaries of meshes of linear cells: new nodes lie on a smooth surface through the nodes of the base mesh."""
