"""The record of rigid grains for the rest of the package."""

from mesokit.method.spheres.common.expected.neighbours import NeighboursOfSpheres
from mesokit.method.spheres.common.method import log_columns, sphere_method
from mesokit.method.spheres.common.motion import SphereDisplacement, VelocityMemory
from mesokit.method.spheres.rigid.checks import check_rigid
from mesokit.method.spheres.rigid.engine.engine import RigidEngine
from mesokit.method.spheres.rigid.expected import RigidCooling, rigid_equilibrium
from mesokit.method.spheres.rigid.first_overlaps import with_start
from mesokit.method.spheres.rigid.observe import MeanSquareDisplacement
from mesokit.method.spheres.rigid.scales import timestep_of
from mesokit.method.spheres.rigid.section import RigidSections
from mesokit.method.spheres.rigid.summary import most_threads, rigid_summary

ENERGIES = ("translation", "rotation", "potential", "contact")
METHOD = sphere_method(
    RigidEngine,
    rigid_equilibrium,
    (RigidCooling, SphereDisplacement, NeighboursOfSpheres, VelocityMemory),
    with_start,
    name="contact-dynamics",
    sections=RigidSections,
    observables=(MeanSquareDisplacement,),
    check=check_rigid,
    timestep=timestep_of,
    summary=rigid_summary,
    most_threads=most_threads,
    box=("shear_rate", "shear_frequency", "shear"),
    log=log_columns(*ENERGIES, usual=("translation", "potential")),
)
