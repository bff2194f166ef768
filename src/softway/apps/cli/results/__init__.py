"""Commands that show what was computed."""
