"""Commands that explain: templates, names, laws, materials, the schema."""
