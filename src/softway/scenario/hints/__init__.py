"""Remedies and types of scenario keys, read from docstrings and annotations."""
