"""Mesh generators for simple shapes."""
