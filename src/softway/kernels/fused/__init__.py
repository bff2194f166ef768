"""Fused kernels: nodal forces of whole bodies in one compiled pass."""
