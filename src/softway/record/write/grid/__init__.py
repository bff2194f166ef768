"""Bodies as one unstructured grid, and series of its frames in a file."""
