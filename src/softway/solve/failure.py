"""How a slab fails: the march drops it and tries a shorter one."""


class NoConvergence(Exception):
    """A slab could not be solved; the message says what happened, with numbers."""
