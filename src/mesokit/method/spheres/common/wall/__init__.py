"""Walls of spheres: rows of numbers for the loops, solids for pictures."""
