"""Kinetic Monte Carlo: rare events on lattices, each at its time (Bortz, Kalos, Lebowitz 1975)."""
