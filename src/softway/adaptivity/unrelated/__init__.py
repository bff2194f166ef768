"""Motion and memory of a solid from one mesh to another one that has no cells in common with it."""
