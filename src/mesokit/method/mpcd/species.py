"""One kind of particle in a fluid of several masses."""

from __future__ import annotations

from mesokit.case.component import component, param


@component
class Species:
    """Particles of one mass in a mixture."""

    mass: float = param(doc="mass of each particle", unit="m", ge=1e-3, le=1e3)
    density: float = param(doc="particles of this kind per cell", unit="1/a^d", gt=0, le=1e12)
