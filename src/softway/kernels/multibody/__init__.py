"""Compiled slabs (time steps) of rigid bodies with joints."""
