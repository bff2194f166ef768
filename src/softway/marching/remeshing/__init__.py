"""March of a scene whose solids have meshes that change (docs/theory/bodies/adaptive.md#march)."""
