"""State of a march: all data that the next slab needs, and the limits of a slab."""
