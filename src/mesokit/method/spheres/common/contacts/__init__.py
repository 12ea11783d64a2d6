"""Spheres that touch: sorting by cells, neighbour lists, walls, and what contacts remember."""
