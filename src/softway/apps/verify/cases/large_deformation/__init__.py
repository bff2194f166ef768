"""Cases of group D: large rotations and strains."""
