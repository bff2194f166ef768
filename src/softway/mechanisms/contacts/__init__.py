"""Stops of a mechanism in a march: touches, impacts, friction."""
