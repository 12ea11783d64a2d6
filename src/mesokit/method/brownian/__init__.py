"""Brownian motion: particles that diffuse and do not feel one another."""

from mesokit.method.brownian.section import Brownian

__all__ = ["Brownian"]
