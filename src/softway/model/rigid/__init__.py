"""Rigid bodies in the model of a scene."""
