"""Kernels of Warp, which run on a CUDA device and on the processor from the same source."""
