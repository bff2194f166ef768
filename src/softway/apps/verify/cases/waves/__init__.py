"""Cases of group A: elastic waves in bars."""
