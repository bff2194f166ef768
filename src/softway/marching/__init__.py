"""March of a scene: accepted slabs (time steps), one after the other."""
