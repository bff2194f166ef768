"""Scenes that several cases march, and their marches as arrays."""
