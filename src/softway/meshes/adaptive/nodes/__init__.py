"""Nodes of the leaves of adapted meshes: numbers, places and tags."""
