"""Figures as they are kept: their file, their page, the machine and the code that they are of."""
