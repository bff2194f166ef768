"""Audit of a run from its geometry: overlaps, inverted cells and balances, found without the rows of the contact."""
