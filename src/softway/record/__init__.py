"""Recorders: consumers of steps, and the reader of what they wrote."""
