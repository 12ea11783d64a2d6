"""Forces of spheres that touch one another, and walls."""

from mesokit.method.soft_spheres.machine.contact import act, solids  # noqa: F401  registers
