"""Which cells of adapted meshes should be fine: indicator, buffers, surfaces of one size."""
