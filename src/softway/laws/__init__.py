"""Material laws: what a point of matter answers to its strain."""
