"""A run in the browser: moving mesh, fields, curves and events, from this machine to this machine."""
