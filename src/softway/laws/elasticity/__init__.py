"""Building blocks of elastic laws: constants, volume change, stress-free directions."""
