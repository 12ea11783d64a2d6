"""Soft spheres: forces that are functions of overlap or distance, and short steps of time."""
