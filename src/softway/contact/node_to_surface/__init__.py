"""Node-to-surface and edge-to-edge contact."""
