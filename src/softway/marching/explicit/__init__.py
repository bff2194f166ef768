"""Massless contact nodes in slabs of central differences."""
