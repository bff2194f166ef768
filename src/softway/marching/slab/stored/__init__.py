"""Compiled slabs (time steps) of solids with stored energies of large deformation."""
