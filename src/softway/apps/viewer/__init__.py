"""Local viewer of a run in the browser: moving mesh, fields, curves and events."""
