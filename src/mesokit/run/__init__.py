"""A run: its loop over steps and all around it."""
