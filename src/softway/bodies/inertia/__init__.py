"""Inertia of a body: mass matrix, redistribution, scaling."""
