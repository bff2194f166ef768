"""Compiled geometry of mortar contact: overlaps of facet pairs, and contact rows."""
