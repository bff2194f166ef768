"""Text of scenarios: reader, writer, templates, overrides."""
