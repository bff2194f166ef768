"""Smooth surfaces through the boundary nodes of base meshes, and fields of meshes that follow them."""
