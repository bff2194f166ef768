"""Shapes of tools and rigid bodies as data of a run folder."""
