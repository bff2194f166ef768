"""Cases of group G: heat conduction and change of phase."""
