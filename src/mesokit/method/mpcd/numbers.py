"""The numbers that follow from a case."""

import dataclasses
from dataclasses import dataclass
from typing import Any

from mesokit import theory
from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.describe.shown import Shown

SHEARED = "lees-edwards"  # between images that move
PIPE = "Hagen-Poiseuille"  # the flow along a round pipe
TIMES = 3  # in which a flow builds up to 5 %, in units of that to 1/e
Row = tuple[str, str, str]  # what, its value, and a word on it


@dataclass(frozen=True, repr=False)
class Derived(Shown):
    """Numbers that follow from a case. Lengths in cells; None where there is no formula.

    `transport` holds the coefficients of the whole fluid, `solvent` those of a fluid without the
    solutes or bodies that are in it, which `suspended` calls by their name.
    `flow_speed` is the largest velocity that theory expects of the steady flow, `flow_bound` that
    of the empty channel where obstacles stand in the flow, whose speed is unknown beforehand,
    `flow_size` the size across it, `reynolds` both over the viscosity (in a round pipe the mean
    velocity, as is the custom), `mach` the largest speed over that of sound; `steady_time` is the
    time in which the flow comes within 1/e of its steady state, `relaxation` the longest
    relaxation time of all molecules and the theory that it is of.
    `heating` is the relative rise of the temperature by friction at the end of the run,
    `heating_bound` says that walls keep it lower.
    `substeps` are those of the fluid's molecules, or else of solutes. `seconds` and `memory`
    (bytes) of the run are estimates, `assumed` says of what.
    """

    particles: int
    particle_steps: int
    mean_free_path: float
    transport: theory.Transport | None
    solvent: theory.Transport | None
    suspended: str
    flow: str
    flow_speed: float | None
    flow_bound: float | None
    flow_size: float
    reynolds: float | None
    mach: float | None
    steady_time: float | None
    relaxation: tuple[float, str] | None
    heating: float | None
    heating_bound: bool
    seconds: float
    memory: int
    trajectory: int
    substeps: int | None
    assumed: str
    warnings: tuple[str, ...]

    def fluid_rows(self) -> list[Row]:
        """Transport coefficients in words; the mean free path alone without a theory."""
        known = self.transport or self.solvent
        path = ("mean free path", number(self.mean_free_path, "a"), "")
        if known is None:
            return [path]
        of = f"without the {self.suspended}" if self.transport is None else ""
        parts = f"kinetic {known.viscosity_kinetic:.4g}, collisional"
        parts = "; ".join(filter(None, [of, f"{parts} {known.viscosity_collisional:.4g}"]))
        return [
            path,
            ("kinematic viscosity", number(known.viscosity, "a^2/tau"), parts),
            ("self-diffusion", number(known.diffusion, "a^2/tau"), of),
            ("Schmidt number", number(known.schmidt), of),
            ("speed of sound", number(known.sound_speed, "a/tau"), of),
        ]

    def flow_rows(self, timestep: float | None = None) -> list[Row]:
        """The steady flow in words, none where there is no flow or no theory of it."""
        if self.flow_bound:
            said = f"obstacles slow it down; {number(self.flow_bound, 'a/time')} without them"
            rows = [("flow speed", "not known", said)]
            if self.transport is not None:
                most = number(self.flow_bound * self.flow_size / self.transport.viscosity)
                rows.append(("Reynolds number", "not known", f"{most} without obstacles"))
        elif self.flow_speed:
            rows = [("flow speed", number(self.flow_speed, "a/tau"), self.flow)]
            if self.reynolds is not None:
                of = "of the mean velocity and the diameter" if self.flow == PIPE else ""
                rows.append(("Reynolds number", number(self.reynolds), of))
            if self.mach is not None:
                within = number(2 * self.mach / self.flow_size)  # a cell
                at = f"at the edges of the box; {within} across a cell, where at most 0.2 is fine"
                rows.append(("Mach number", number(self.mach), at if self.flow == SHEARED else ""))
        else:
            return []
        if self.steady_time is not None:
            steps = "" if timestep is None else f"{round(self.steady_time / timestep)} steps to 1/e"
            steps += ", without obstacles" if self.flow_bound else ""
            rows.append(("time to build up", number(self.steady_time), steps))
        return rows

    def rows(self) -> list[Row]:
        """All of it in words."""
        particles = f"{self.particles:,}".replace(",", " ")
        return [
            ("particles", particles, ""),
            *self.fluid_rows(),
            *self.flow_rows(),
            ("run time", duration_text(self.seconds), f"estimate: {self.assumed}"),
            ("memory", size_text(self.memory), "estimate"),
        ]

    def record(self) -> dict[str, Any]:
        """All of it as plain numbers and texts, but for the warnings."""
        return {key: value for key, value in dataclasses.asdict(self).items() if key != "warnings"}

    def _card(self) -> dict[str, Any]:
        warnings = [("warning", text, "") for text in self.warnings]
        return {"title": "derived numbers", "rows": [*self.rows(), *warnings], "pretty": True}

    def __repr__(self) -> str:
        rows = [*self.rows(), *(("warning", text, "") for text in self.warnings)]
        width = max(len(name) for name, _, _ in rows)
        return "\n".join(f"{name:{width}}  {v}  {word}".rstrip() for name, v, word in rows)
