"""What compiled slabs (time steps) need of a model on the side of its contacts, loads and supports."""
