"""Cases of group I: orders of convergence, and meshes that adapt."""
