"""Forces of spheres that touch one another, and walls."""

from mesokit.method.spheres.soft.engine.contact import walls  # noqa: F401  registers
