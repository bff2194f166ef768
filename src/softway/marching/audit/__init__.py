"""Audit of a slab: certificate and ledger."""
