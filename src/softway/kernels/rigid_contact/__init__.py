"""Compiled contact of rigid bodies with friction."""
