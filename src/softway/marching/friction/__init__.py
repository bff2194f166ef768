"""Friction events inside a slab: stick, slip and their instants."""
