"""Exact solutions: motions and equilibria known independently of the method."""
