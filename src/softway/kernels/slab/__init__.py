"""Compiled slabs (time steps) of bodies with linear laws on fixed contact rows."""
