"""Contact by elimination of the closed rows inside conjugate gradients."""
