"""Notes on parts of a scenario that are computed, although their results may be wrong."""
