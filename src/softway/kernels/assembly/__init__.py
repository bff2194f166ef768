"""Assembly: sparsity patterns, order of the cells, sums from cells to nodes."""
