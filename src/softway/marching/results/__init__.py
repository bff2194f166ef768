"""Results of a slab and of its friction, and accepted steps."""
