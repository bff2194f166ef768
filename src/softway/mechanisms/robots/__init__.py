"""Mechanisms from files of robots, URDF and MJCF."""
