"""March of a model over several ranks: the model of a rank, its state, and the steps of all of them."""
