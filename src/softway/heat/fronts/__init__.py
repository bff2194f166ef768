"""Fronts of melting between the nodes of bars."""
