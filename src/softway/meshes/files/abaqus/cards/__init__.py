"""Cards of an input deck that give nodes, elements, sets and surfaces."""
