"""Internal force of elastic bodies."""
