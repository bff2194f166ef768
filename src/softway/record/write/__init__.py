"""Writers of the records of a run."""
