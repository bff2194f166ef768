"""Kernels: functions of arrays and sizes that know no physics."""
