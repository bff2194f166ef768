"""Pictures of a mechanism: its bodies at some instants, with the paths of their points."""
