"""March of solids whose degraded meshes are replaced between slabs (docs/theory/bodies/remeshing.md)."""
