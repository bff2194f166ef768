"""Set-up of a body: placement, loads, amplitudes, initial fields."""
