"""Figures of single particles: where they are, how fast, how they are spread."""
