"""Assembled quantities of all solids: masses, loads, material states."""
