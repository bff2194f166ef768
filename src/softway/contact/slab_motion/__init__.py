"""Motion of contact nodes inside a slab, with the instants of touch and release."""
