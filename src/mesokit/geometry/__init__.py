"""Walls: shapes of solids, and what their surfaces do."""
