"""One slab (time step): from a state to the next, with the rigid bodies of the model."""
