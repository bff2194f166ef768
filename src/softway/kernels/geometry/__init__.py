"""Geometry of contact: closest points, clipping, event times."""
