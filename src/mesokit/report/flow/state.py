"""Pictures of a simulation in memory, as it is now: before its first step, where it starts from."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.trajectory import masses_and_kinds
from mesokit.io.contact_records import FIELD, records_of

MOST = 20_000  # particles of the first group, evenly picked where there are more
READ = {"position": "positions", "velocity": "velocities", "spin": "spins", "site": "sites"}


class Now(dict[str, Any]):
    """The fields of a frame; contacts are found when they are drawn, since that compiles code."""

    def __init__(self, fields: dict[str, Any], engine: Any) -> None:
        super().__init__(fields)
        self.engine = engine

    def __missing__(self, name: str) -> Any:
        if name != FIELD:
            raise KeyError(name)
        return records_of(self.engine.contacts(), 0, self.engine.n, float)


class State:
    """One frame of the particles of an engine, read as a `TrajectoryReader` is.

    Spheres have all fields that trajectories may hold, and all spheres are in it.
    """

    def __init__(self, case: Case, engine: Any) -> None:
        number, spheres = case.particles, case.particles_have("diameter")
        shown = number if spheres else min(MOST, number)
        self.fields: tuple[str, ...] = ("position",)
        if spheres:
            self.fields = ("position", "velocity", "spin")
            self.fields += (FIELD,) * case.particles_have(FIELD)
        elif any("orientation" in group.has for group in case.groups):
            self.fields += ("orientation",)
        elif case.particles_have("heading"):
            self.fields = ("position", "velocity")
        elif case.particles_have("site"):
            self.fields, shown = ("site",), number
        picked = np.arange(shown) * number // max(shown, 1)
        others = np.arange(number, sum(group.number for group in case.groups))
        masses, kinds = masses_and_kinds(case.groups)
        self.id = np.concatenate([picked, others])
        self.species = kinds[self.id]
        self.mass = masses[self.species]
        self.step, self.time = np.array([engine.step]), np.array([engine.time])
        self.engine = engine
        first = sum(group.number for group in case.groups if "orientation" not in group.has)
        self.bodies = self.id >= first
        self.diameter: NDArray[np.float64] | None = None
        if spheres:
            self.mass, self.diameter = engine.masses(self.id), engine.diameters(self.id)

    def __len__(self) -> int:
        return 1

    def __getitem__(self, index: int) -> dict[str, Any]:
        """The frame."""
        known = [name for name in self.fields if name in READ]
        read = {name: getattr(self.engine, READ[name])(self.id) for name in known}
        if "orientation" in self.fields:
            read["orientation"] = np.full((len(self.id), 4), np.nan)
            read["orientation"][self.bodies] = self.engine.orientations(self.id[self.bodies])
        return Now(read, self.engine)
