"""The equations of one slab and the methods that solve them."""
