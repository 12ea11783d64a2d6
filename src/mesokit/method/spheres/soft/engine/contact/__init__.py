"""Forces of spheres that touch one another, and walls."""

from mesokit.method.spheres.soft.engine.contact import act, solids  # noqa: F401  registers
