"""Reader of Gmsh files in the versions 2.2, 4.0 and 4.1, as text and as bytes: names, nodes, elements and groups."""
