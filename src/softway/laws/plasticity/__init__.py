"""Building blocks of plastic laws: hardening, rate dependence, return mapping."""
