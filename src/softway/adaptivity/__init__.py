"""Motion and memory of solids on meshes that change (docs/theory/bodies/adaptive.md)."""
