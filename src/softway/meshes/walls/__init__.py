"""Walls one cell thick: where they are, and their division into two layers."""
