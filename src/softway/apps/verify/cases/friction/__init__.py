"""Cases of group C: friction."""
