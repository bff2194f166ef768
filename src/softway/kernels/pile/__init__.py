"""Compiled loops of piles of balls: search for contacts, islands, sweeps, slabs (time steps)."""
