"""Contact surfaces: boundaries, facets, broad phase, nodal tractions."""
