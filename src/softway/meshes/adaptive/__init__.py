"""Meshes refined by bisection of a base mesh, and what two of them have in common (docs/theory/bodies/adaptive.md)."""
