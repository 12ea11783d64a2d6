"""What a case may say, described from its components: JSON schema, explanations, docstrings."""
