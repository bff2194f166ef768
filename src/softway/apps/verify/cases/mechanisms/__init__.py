"""Cases of group F: rigid bodies and mechanisms."""
