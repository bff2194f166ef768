"""Linear solvers and their backends."""
