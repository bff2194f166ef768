"""Processes that share a model: what they send each other, sums that do not depend on their number, who has what."""
