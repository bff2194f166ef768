"""Compiled slabs (time steps) of bodies with stored energies of large deformation on fixed contact rows."""
