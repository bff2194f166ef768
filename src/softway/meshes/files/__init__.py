"""Readers of mesh files and Abaqus decks."""
