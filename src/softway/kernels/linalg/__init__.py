"""Small dense linear algebra at many points at once."""
