"""Linear solves on a device."""
