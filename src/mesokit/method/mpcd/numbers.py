"""The numbers that follow from a case."""

from __future__ import annotations

from dataclasses import dataclass

from mesokit import theory


@dataclass(frozen=True)
class Derived:
    """What follows from a case. Lengths in cells; None where there is no formula.

    `flow_speed` is the largest velocity that theory expects of the steady flow, `flow_size` the
    size across it, `reynolds` both over the viscosity, `mach` the speed over that of sound;
    `steady_time` is the time in which the flow comes within 1/e of its steady state. `substeps` are
    those of molecules. `seconds` and `memory` (bytes) of the run are estimates, `assumed` says of
    what.
    """

    particles: int
    particle_steps: int
    transport: theory.Transport | None
    flow: str
    flow_speed: float | None
    flow_size: float
    reynolds: float | None
    mach: float | None
    steady_time: float | None
    heating: float | None
    seconds: float
    memory: int
    trajectory: int
    substeps: int | None
    assumed: str
    warnings: tuple[str, ...]
