"""The record of soft spheres for the rest of the package."""

from mesokit.method.spheres.common.expected.neighbours import NeighboursOfSpheres
from mesokit.method.spheres.common.method import log_columns, sphere_method
from mesokit.method.spheres.common.motion import VelocityMemory
from mesokit.method.spheres.soft.checks import check_soft
from mesokit.method.spheres.soft.engine.engine import SoftEngine
from mesokit.method.spheres.soft.expected import SoftCooling, SoftDisplacement, soft_equilibrium
from mesokit.method.spheres.soft.first_speeds import with_speed
from mesokit.method.spheres.soft.observe import MeanSquareDisplacement
from mesokit.method.spheres.soft.scales import timestep_of
from mesokit.method.spheres.soft.section import SoftSections
from mesokit.method.spheres.soft.summary import soft_summary

ENERGIES = ("translation", "rotation", "potential", "contact")
METHOD = sphere_method(
    SoftEngine,
    soft_equilibrium,
    (SoftCooling, SoftDisplacement, NeighboursOfSpheres, VelocityMemory),
    with_speed,
    name="soft-spheres",
    sections=SoftSections,
    observables=(MeanSquareDisplacement,),
    check=check_soft,
    timestep=timestep_of,
    summary=soft_summary,
    log=log_columns(*ENERGIES, usual=("translation", "potential")),
)
