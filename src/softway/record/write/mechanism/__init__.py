"""Records of a mechanism: its history, the motion of its bodies, the events of its stops, and its outline."""
