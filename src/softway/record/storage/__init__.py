"""Files of a run folder: atomic writes, journal, lock, serialisation."""
