"""Cases of group E: viscous and plastic forming."""
