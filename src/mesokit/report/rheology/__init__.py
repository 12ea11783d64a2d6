"""Figures of rheometry."""
