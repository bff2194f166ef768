"""Start of a march: initial overlap and initial state."""
