"""Curves over time: history, paths, comparisons."""
