"""Slabs (time steps) of solids with rigid bodies: motions and forces of both until they agree."""
