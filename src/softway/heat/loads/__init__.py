"""Loads of heat on discretised conductors."""
