"""The cases: each module computes one of them, ``compute() -> Outcome``."""
