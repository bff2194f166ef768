"""Static equilibrium, from which a march may start or go on."""
