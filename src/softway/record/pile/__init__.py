"""Records of piles: columns of the history, places of the balls, the parts at the start, and the summary."""
