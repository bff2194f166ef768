"""Geometry of the audit: bodies as cells and flat pieces, and where they overlap."""
