"""Walls: shapes of solids, and rules of their surfaces."""
