"""Families of runs: the same case for several values and seeds, and what they say together."""
