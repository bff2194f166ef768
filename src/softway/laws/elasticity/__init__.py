"""Building blocks of elastic laws: constants, Hooke's law, volume change, stress-free directions."""
