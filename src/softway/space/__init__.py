"""Meshes: cells, elements as tables, shapes, files, obstacles."""
