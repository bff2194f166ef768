"""Bodies: what owns velocity unknowns, and what it is made of."""
