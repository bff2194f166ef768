"""Temperature of solids that move, as a companion field of their displacement."""
