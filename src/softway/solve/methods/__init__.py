"""Methods of solution of a slab: fixed point, Newton, central differences."""
