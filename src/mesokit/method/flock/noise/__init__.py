"""Noise of birds. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.flock.noise.protocol import Noise

__getattr__ = parts_in(__name__, RULES=Noise)

__all__ = ["RULES", "Noise"]
