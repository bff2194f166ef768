"""Applications: the command line, the verification suite and the viewer."""
