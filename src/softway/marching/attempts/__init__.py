"""Attempts at the next slab (time step), with cutbacks until a slab is accepted."""
