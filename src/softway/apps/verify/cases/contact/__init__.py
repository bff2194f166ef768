"""Cases of group B: contact of elastic solids."""
