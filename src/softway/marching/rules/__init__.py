"""Contact rules: how a slab with contact is solved."""
