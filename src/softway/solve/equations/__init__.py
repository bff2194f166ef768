"""Equations of a slab: residual, operator and energy balance."""
