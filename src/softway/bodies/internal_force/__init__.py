"""Internal force of a body: one interface for elastic and path-dependent materials."""
