"""Reader of Abaqus and CalculiX input decks: cards, includes, parts and instances, generators, sets and surfaces."""
