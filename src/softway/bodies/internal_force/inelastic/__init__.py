"""Internal force of bodies with path-dependent laws."""
