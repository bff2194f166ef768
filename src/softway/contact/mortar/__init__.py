"""Mortar contact: weighted gaps over the overlap of two surfaces."""
