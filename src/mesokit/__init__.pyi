"""The public names and where they are: the one table, read by type checkers and at run time."""

__version__: str

from mesokit import theory as theory
from mesokit.case.box import Box as Box
from mesokit.case.case import Case as Case
from mesokit.case.component import component as component
from mesokit.case.component import param as param
from mesokit.case.component import tag as tag
from mesokit.case.log import Log as Log
from mesokit.case.run import Run as Run
from mesokit.case.trajectory import Trajectory as Trajectory
from mesokit.case.units import OtherFluid as OtherFluid
from mesokit.case.units import Units as Units
from mesokit.case.units import Water as Water
from mesokit.errors import CaseError as CaseError
from mesokit.errors import CheckpointError as CheckpointError
from mesokit.errors import MesokitError as MesokitError
from mesokit.errors import RunError as RunError
from mesokit.geometry.shape.array import Array as Array
from mesokit.geometry.shape.capsule import Capsule as Capsule
from mesokit.geometry.shape.cosine_channel import CosineChannel as CosineChannel
from mesokit.geometry.shape.cuboid import Cuboid as Cuboid
from mesokit.geometry.shape.cylinder import Cylinder as Cylinder
from mesokit.geometry.shape.disk import Disk as Disk
from mesokit.geometry.shape.half_space import HalfSpace as HalfSpace
from mesokit.geometry.shape.intersection import Intersection as Intersection
from mesokit.geometry.shape.mesh import Mesh as Mesh
from mesokit.geometry.shape.picture import Picture as Picture
from mesokit.geometry.shape.plates import Plates as Plates
from mesokit.geometry.shape.rectangle import Rectangle as Rectangle
from mesokit.geometry.shape.sampled import Sampled as Sampled
from mesokit.geometry.shape.sphere import Sphere as Sphere
from mesokit.geometry.shape.union import Union as Union
from mesokit.geometry.shape_protocol import Shape as Shape
from mesokit.geometry.shape_protocol import Simple as Simple
from mesokit.geometry.solids.solids import Solids as Solids
from mesokit.geometry.surface import Surface as Surface
from mesokit.io.open import RunFiles as RunFiles
from mesokit.io.open import open as open
from mesokit.method.mpcd.collision.at import AT as AT
from mesokit.method.mpcd.collision.at_plus_a import ATPlusA as ATPlusA
from mesokit.method.mpcd.collision.protocol import CollisionRule as CollisionRule
from mesokit.method.mpcd.collision.srd import SRD as SRD
from mesokit.method.mpcd.collision.srd_plus_a import SRDPlusA as SRDPlusA
from mesokit.method.mpcd.derived import derive as derive
from mesokit.method.mpcd.field.none import NoForce as NoForce
from mesokit.method.mpcd.field.protocol import Force as Force
from mesokit.method.mpcd.field.sinusoidal import Sinusoidal as Sinusoidal
from mesokit.method.mpcd.field.uniform import Uniform as Uniform
from mesokit.method.mpcd.fluid import Fluid as Fluid
from mesokit.method.mpcd.molecule import Molecule as Molecule
from mesokit.method.mpcd.numbers import Derived as Derived
from mesokit.method.mpcd.si import SI as SI
from mesokit.method.mpcd.si import convert as convert
from mesokit.method.mpcd.solutes import Polymer as Polymer
from mesokit.method.mpcd.solutes import Solutes as Solutes
from mesokit.method.mpcd.species import Species as Species
from mesokit.method.mpcd.start.section import Start as Start
from mesokit.method.mpcd.thermostat.maxwell_boltzmann import MaxwellBoltzmann as MaxwellBoltzmann
from mesokit.method.mpcd.thermostat.none import NoThermostat as NoThermostat
from mesokit.method.mpcd.thermostat.protocol import Thermostat as Thermostat
from mesokit.method.mpcd.thermostat.rescale import Rescale as Rescale
from mesokit.observe.bond_length import BondLength as BondLength
from mesokit.observe.conservation import Conservation as Conservation
from mesokit.observe.density_field import DensityField as DensityField
from mesokit.observe.density_profile import DensityProfile as DensityProfile
from mesokit.observe.dynamic_moduli import DynamicModuli as DynamicModuli
from mesokit.observe.flow_frames import FlowFrames as FlowFrames
from mesokit.observe.flow_rate import FlowRate as FlowRate
from mesokit.observe.forces import Forces as Forces
from mesokit.observe.longitudinal_modes import LongitudinalModes as LongitudinalModes
from mesokit.observe.mean_square_displacement import (
    MeanSquareDisplacement as MeanSquareDisplacement,
)
from mesokit.observe.molecule_size import MoleculeSize as MoleculeSize
from mesokit.observe.normal_modes import NormalModes as NormalModes
from mesokit.observe.probe import Probe as Probe
from mesokit.observe.radial_profile import RadialProfile as RadialProfile
from mesokit.observe.shared.protocol import Observable as Observable
from mesokit.observe.shared.result import Comparison as Comparison
from mesokit.observe.shared.result import Result as Result
from mesokit.observe.stress import Stress as Stress
from mesokit.observe.stress_autocorrelation import StressAutocorrelation as StressAutocorrelation
from mesokit.observe.surface_profile import SurfaceProfile as SurfaceProfile
from mesokit.observe.temperature_profile import TemperatureProfile as TemperatureProfile
from mesokit.observe.transverse_modes import TransverseModes as TransverseModes
from mesokit.observe.velocity_autocorrelation import (
    VelocityAutocorrelation as VelocityAutocorrelation,
)
from mesokit.observe.velocity_field import VelocityField as VelocityField
from mesokit.observe.velocity_profile import VelocityProfile as VelocityProfile
from mesokit.observe.wake import Wake as Wake
from mesokit.observe.wall_stress import WallStress as WallStress
from mesokit.potential.bending import Bending as Bending
from mesokit.potential.fene import FENE as FENE
from mesokit.potential.harmonic import Harmonic as Harmonic
from mesokit.potential.harmonic import Spring as Spring
from mesokit.potential.lennard_jones import LennardJones as LennardJones
from mesokit.potential.protocol import Angle as Angle
from mesokit.potential.protocol import Bond as Bond
from mesokit.potential.protocol import Pair as Pair
from mesokit.potential.wca import WCA as WCA
from mesokit.running.callbacks import Callback as Callback
from mesokit.running.callbacks import StopRun as StopRun
from mesokit.running.callbacks import every as every
from mesokit.simulation import Simulation as Simulation
