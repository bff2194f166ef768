"""Projections of fields from one adapted mesh of a solid to another."""
