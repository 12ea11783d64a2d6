"""Lattices: their sites, the neighbours of each, and where these are in memory."""
