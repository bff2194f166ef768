"""Pictures of piles of balls."""
