"""Meshes that replace degraded ones: when, and what passes from one to the next."""
