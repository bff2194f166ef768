"""Quadrilaterals and hexahedra: balanced trees, and their nodes."""
