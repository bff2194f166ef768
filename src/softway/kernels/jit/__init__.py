"""Compilation of kernels with Numba, threads and vector lanes."""
