"""Places of the nodes of a degraded mesh: quality of cells, new places on the old boundary and inside."""
