"""Shared parts of the observables of fluids."""
