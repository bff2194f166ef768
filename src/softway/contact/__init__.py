"""Contact: who may touch whom, how nodes move inside a slab, and the rules in time."""
