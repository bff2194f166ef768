"""Numerical kernels: functions of plain arrays."""
