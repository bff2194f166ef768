"""Terminal output of the commands: tables, progress, logs and folders."""
