"""Descriptions of the keys of a case: JSON schema, explanations and docstrings."""
