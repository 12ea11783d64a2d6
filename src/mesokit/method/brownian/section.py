"""The section of a case of Brownian motion."""

from __future__ import annotations

from pydantic import model_validator

from mesokit.case.box import Box
from mesokit.case.component import component, param, show
from mesokit.case.given.file import FileName


@component
class Brownian:
    """Particles that diffuse freely in the periodic box: dx = sqrt(2 D dt) xi along each axis."""

    density: float = param(1.0, doc="particles per cell", unit="1/length^d", gt=0)
    diffusion: float = param(1.0, doc="diffusion coefficient D", unit="length^2/time", gt=0)
    timestep: float = param(0.01, doc="time of a step", ge=1e-9, le=1e6)
    positions: FileName | None = param(
        None,
        doc="start from these: file .npy with an (n, d) array (drawn unless said)",
        unit="length",
    )
    scale: float | None = param(
        None, doc="cells per length of these positions (1 unless said)", gt=0, le=1e12
    )

    @model_validator(mode="after")
    def _scaled_file(self) -> Brownian:
        if self.scale is not None and self.positions is None:
            raise ValueError(f"scale = {show(self.scale)}: only with positions")
        return self

    def number(self, box: Box) -> int:
        """How many particles there are."""
        return round(self.density * box.volume)


class Sections:
    """What a case of Brownian motion has beside the sections of every case."""

    brownian: Brownian = param(Brownian(), doc="the particles")
