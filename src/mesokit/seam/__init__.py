"""Protocols of methods, engines and observables, and results."""
