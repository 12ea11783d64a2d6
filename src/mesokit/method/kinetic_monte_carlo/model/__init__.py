"""Models of lattices. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.kinetic_monte_carlo.model.protocol import Model

__getattr__ = parts_in(__name__, MODELS=Model)

__all__ = ["MODELS", "Model"]
