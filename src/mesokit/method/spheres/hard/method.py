"""The record of event-driven dynamics for the rest of the package."""

from mesokit.method.spheres.common.method import log_columns, sphere_method
from mesokit.method.spheres.hard.checks import check_hard
from mesokit.method.spheres.hard.engine.engine import EventDriven
from mesokit.method.spheres.hard.expected import (
    EnskogMemory,
    HardCooling,
    HardDisplacement,
    HardNeighbours,
    hard_equilibrium,
)
from mesokit.method.spheres.hard.observe import MeanSquareDisplacement
from mesokit.method.spheres.hard.section import HardSections
from mesokit.method.spheres.hard.summary import hard_summary

ENERGIES, COUNTS = ("translation", "rotation", "potential"), ("collisions", "wall collisions")
METHOD = sphere_method(
    EventDriven,
    hard_equilibrium,
    (HardCooling, HardDisplacement, EnskogMemory, HardNeighbours),
    name="event-driven",
    sections=HardSections,
    observables=(MeanSquareDisplacement,),
    check=check_hard,
    timestep=lambda case: float(case.spheres.timestep),
    summary=hard_summary,
    log=log_columns(*ENERGIES, *COUNTS, usual=("translation", "collisions")),
)
