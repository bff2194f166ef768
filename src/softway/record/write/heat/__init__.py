"""Records of conductors: columns of the history, frames of the temperature, probes, and the parts at the start."""
