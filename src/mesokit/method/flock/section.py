"""The sections of a case of a flock."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from mesokit.case.box import Box
from mesokit.case.component import component, param, show
from mesokit.case.describe.hints import Many
from mesokit.case.given.file import FileName
from mesokit.geometry.shape import Wall
from mesokit.method.flock.cohesion import Cohesion
from mesokit.method.flock.noise import Noise
from mesokit.method.flock.noise.angular import AngularNoise

KEYS = {"walls": "wall"}  # field -> key in the file, where they differ
DENSITY = 2.0  # unless said
BYTES = {2: 160, 3: 230}  # of memory for each bird


@component
class FlockStart:
    """Where birds start from; without files they are spread at random over the box."""

    headings: Literal["random", "aligned"] = param(
        "random", doc="'random': in all directions; 'aligned': all along x"
    )
    positions: FileName | None = param(None, doc="file .npy with an (n, d) array", unit="length")
    velocities: FileName | None = param(
        None,
        doc="file .npy with an (n, d) array, of which the directions count",
        unit="length/time",
    )
    run: FileName | None = param(None, doc="folder of an earlier run: go on from its last state")
    file: FileName | None = param(None, doc="GSD file (its last frame) or LAMMPS data file")
    scale: float | None = param(
        None, doc="lengths of the case per length of these files (1 unless said)", gt=0, le=1e12
    )

    @model_validator(mode="after")
    def _scaled_file(self) -> FlockStart:
        if self.scale is not None and not (self.file or self.positions):
            raise ValueError(f"scale = {show(self.scale)}: only with file or positions")
        return self


@component
class Flock:
    """Birds that fly at one speed, as the mean of those in reach, and err (Vicsek et al. 1995)."""

    density: float | None = param(
        None,
        doc="birds per cell (2 unless a number is given)",
        symbol=r"\rho",
        unit="1/length^d",
        gt=0,
        le=1e15,
    )
    number: int | None = param(None, doc="birds in all, in place of the density", symbol="N", ge=1)
    radius: float = param(1.0, doc="reach of a bird's sight", unit="length", gt=0)
    speed: float = param(0.5, doc="of all birds", symbol="v", unit="length/time", gt=0, le=1e6)
    timestep: float = param(1.0, doc="time of a step", ge=1e-9, le=1e6)
    noise: Noise = param(AngularNoise(), doc="what keeps birds from flying as the others do")
    order: Literal["synchronous", "original"] = param(
        "synchronous",
        doc="'synchronous': birds move along their new headings; 'original': along the old ones, "
        "as in the paper of 1995",
    )
    cohesion: Cohesion | None = param(None, doc="repulsion and cohesion (none unless said)")
    start: FlockStart = param(FlockStart(), doc="where birds start from")

    @model_validator(mode="after")
    def _number_or_density(self) -> Flock:
        if self.number is not None and self.density is not None:
            raise ValueError(f"number = {show(self.number)}: not with density; leave one out")
        return self

    def birds(self, box: Box) -> int:
        """How many birds there are."""
        if self.number is not None:
            return self.number
        return round((DENSITY if self.density is None else self.density) * box.volume)


class Sections:
    """What a case of a flock has beside the sections of every case."""

    flock: Flock = param(Flock(), doc="the birds")
    walls: Many[Wall] = param((), doc="walls; key `[[wall]]` in a file")
