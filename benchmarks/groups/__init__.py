"""Groups of measurements: each module yields its figures."""
