"""Time: the slab and its virtual time function."""
