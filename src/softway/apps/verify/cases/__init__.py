"""Verification cases. Each module computes one case with ``compute() -> Outcome``."""
