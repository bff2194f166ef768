"""Finite elements of a body: quadrature, sections, strains, mean dilatation."""
