"""What the strain of solids with a temperature stores: thermal expansion, and energy whose moduli depend on it."""
