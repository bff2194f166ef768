"""Rigid bodies that touch: impacts, rest, friction."""
