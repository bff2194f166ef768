"""Exact solutions: motions and equilibria that are known without the method."""
