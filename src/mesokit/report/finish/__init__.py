"""Finish of a drawing: legend, several in one plot, where it comes from, file."""
