"""Contact and friction constraints: compliance, active set, return map."""
