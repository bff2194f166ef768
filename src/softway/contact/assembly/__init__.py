"""Assembly of the declared contacts of a model: their surfaces, methods and friction."""
