"""Cells of a rank: their materials, forces and stored rows."""
