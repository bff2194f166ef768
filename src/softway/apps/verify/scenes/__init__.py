"""Scenes shared by several cases, with their marches as arrays."""
