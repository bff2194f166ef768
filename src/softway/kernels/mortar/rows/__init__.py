"""Rows of mortar contact from the pairs of simplices."""
