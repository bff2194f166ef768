"""From a scene to accepted slabs."""
