"""Flaws of meshes: cells that overlap, hinges, and parts that nothing holds together."""
