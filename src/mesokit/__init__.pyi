"""The public names and where they are: the one table, read by type checkers and at run time."""

__version__: str

from mesokit import theory as theory
from mesokit.case.box import Box as Box
from mesokit.case.case import Case as Case
from mesokit.case.component import component as component
from mesokit.case.component import param as param
from mesokit.case.component import tag as tag
from mesokit.case.describe.explain import explain as explain
from mesokit.case.describe.schema import schema as schema
from mesokit.case.run import Log as Log
from mesokit.case.run import Run as Run
from mesokit.case.shear.oscillating import OscillatingShear as OscillatingShear
from mesokit.case.shear.protocol import ShearHistory as ShearHistory
from mesokit.case.shear.steady import SteadyShear as SteadyShear
from mesokit.case.shear.two_ramps import Cessation as Cessation
from mesokit.case.shear.two_ramps import ShearRamp as ShearRamp
from mesokit.case.shear.two_ramps import StartUp as StartUp
from mesokit.case.shear.two_ramps import StepStrain as StepStrain
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
from mesokit.geometry.shape.ellipse import Ellipse as Ellipse
from mesokit.geometry.shape.half_space import HalfSpace as HalfSpace
from mesokit.geometry.shape.intersection import Intersection as Intersection
from mesokit.geometry.shape.mesh import Mesh as Mesh
from mesokit.geometry.shape.picture import Picture as Picture
from mesokit.geometry.shape.plates import Plates as Plates
from mesokit.geometry.shape.rectangle import Rectangle as Rectangle
from mesokit.geometry.shape.sampled import Sampled as Sampled
from mesokit.geometry.shape.sphere import Sphere as Sphere
from mesokit.geometry.shape.spheroid import Spheroid as Spheroid
from mesokit.geometry.shape.union import Union as Union
from mesokit.geometry.shape_protocol import Shape as Shape
from mesokit.geometry.shape_protocol import Simple as Simple
from mesokit.geometry.solids.solids import Solids as Solids
from mesokit.geometry.surface import Surface as Surface
from mesokit.geometry.surface import SurfaceContact as SurfaceContact
from mesokit.method.flock.cohesion import Cohesion as Cohesion
from mesokit.method.flock.noise.angular import AngularNoise as AngularNoise
from mesokit.method.flock.noise.protocol import Noise as Noise
from mesokit.method.flock.noise.vectorial import VectorialNoise as VectorialNoise
from mesokit.method.flock.observe.cluster_sizes import ClusterSizes as ClusterSizes
from mesokit.method.flock.observe.density_bands import DensityBands as DensityBands
from mesokit.method.flock.observe.number_fluctuations import (
    NumberFluctuations as NumberFluctuations,
)
from mesokit.method.flock.observe.polar_order import PolarOrder as PolarOrder
from mesokit.method.flock.section import Flock as Flock
from mesokit.method.flock.section import FlockStart as FlockStart
from mesokit.method.kinetic_monte_carlo.model.aggregation import Aggregation as Aggregation
from mesokit.method.kinetic_monte_carlo.model.ballistic import Ballistic as Ballistic
from mesokit.method.kinetic_monte_carlo.model.eden import Eden as Eden
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion as Exclusion
from mesokit.method.kinetic_monte_carlo.model.family import Family as Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising as Ising
from mesokit.method.kinetic_monte_carlo.model.islands import Islands as Islands
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess as GasProcess
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import LatticeGas as LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts as Potts
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies as Energies
from mesokit.method.kinetic_monte_carlo.model.random_deposition import (
    RandomDeposition as RandomDeposition,
)
from mesokit.method.kinetic_monte_carlo.model.rsos import (
    RestrictedSolidOnSolid as RestrictedSolidOnSolid,
)
from mesokit.method.kinetic_monte_carlo.model.single_step import SingleStep as SingleStep
from mesokit.method.kinetic_monte_carlo.model.sintering import Sintering as Sintering
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid as SolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.surface_diffusion import (
    SurfaceDiffusion as SurfaceDiffusion,
)
from mesokit.method.kinetic_monte_carlo.model.table import Process as Process
from mesokit.method.kinetic_monte_carlo.model.table import TableModel as TableModel
from mesokit.method.kinetic_monte_carlo.model.wells import Link as Link
from mesokit.method.kinetic_monte_carlo.model.wells import Ring as Ring
from mesokit.method.kinetic_monte_carlo.model.wells import Well as Well
from mesokit.method.kinetic_monte_carlo.model.wells import Wells as Wells
from mesokit.method.kinetic_monte_carlo.observe.coverage import Coverage as Coverage
from mesokit.method.kinetic_monte_carlo.observe.crossings import Crossings as Crossings
from mesokit.method.kinetic_monte_carlo.observe.current import Current as Current
from mesokit.method.kinetic_monte_carlo.observe.domain_length import DomainLength as DomainLength
from mesokit.method.kinetic_monte_carlo.observe.event_rates import EventRates as EventRates
from mesokit.method.kinetic_monte_carlo.observe.height_differences import (
    HeightDifferences as HeightDifferences,
)
from mesokit.method.kinetic_monte_carlo.observe.height_steps import HeightSteps as HeightSteps
from mesokit.method.kinetic_monte_carlo.observe.island_density import IslandDensity as IslandDensity
from mesokit.method.kinetic_monte_carlo.observe.island_sizes import IslandSizes as IslandSizes
from mesokit.method.kinetic_monte_carlo.observe.lattice_energy import LatticeEnergy as LatticeEnergy
from mesokit.method.kinetic_monte_carlo.observe.magnetisation import Magnetisation as Magnetisation
from mesokit.method.kinetic_monte_carlo.observe.order_parameter import (
    OrderParameter as OrderParameter,
)
from mesokit.method.kinetic_monte_carlo.observe.roughness import Roughness as Roughness
from mesokit.method.kinetic_monte_carlo.observe.site_correlation import (
    SiteCorrelation as SiteCorrelation,
)
from mesokit.method.kinetic_monte_carlo.observe.site_profile import SiteProfile as SiteProfile
from mesokit.method.kinetic_monte_carlo.observe.site_structure_factor import (
    SiteStructureFactor as SiteStructureFactor,
)
from mesokit.method.kinetic_monte_carlo.observe.tracer_displacement import (
    TracerDisplacement as TracerDisplacement,
)
from mesokit.method.kinetic_monte_carlo.observe.waiting_times import WaitingTimes as WaitingTimes
from mesokit.method.kinetic_monte_carlo.section import Lattice as Lattice
from mesokit.method.kinetic_monte_carlo.section import Sublattices as Sublattices
from mesokit.method.kinetic_monte_carlo.start import AlternatingStart as AlternatingStart
from mesokit.method.kinetic_monte_carlo.start import DropletStart as DropletStart
from mesokit.method.kinetic_monte_carlo.start import GrainsStart as GrainsStart
from mesokit.method.kinetic_monte_carlo.start import NucleusStart as NucleusStart
from mesokit.method.kinetic_monte_carlo.start import SlabStart as SlabStart
from mesokit.method.kinetic_monte_carlo.start import TerraceStart as TerraceStart
from mesokit.method.kinetic_monte_carlo.start import UniformStart as UniformStart
from mesokit.method.mpcd.body.capsule import CapsuleBody as CapsuleBody
from mesokit.method.mpcd.body.cuboid import CuboidBody as CuboidBody
from mesokit.method.mpcd.body.disk import DiskBody as DiskBody
from mesokit.method.mpcd.body.ellipse import EllipseBody as EllipseBody
from mesokit.method.mpcd.body.protocol import Body as Body
from mesokit.method.mpcd.body.protocol import BodyStart as BodyStart
from mesokit.method.mpcd.body.protocol import BodyTrap as BodyTrap
from mesokit.method.mpcd.body.protocol import CounterForce as CounterForce
from mesokit.method.mpcd.body.protocol import GapPotential as GapPotential
from mesokit.method.mpcd.body.protocol import Squirming as Squirming
from mesokit.method.mpcd.body.rectangle import RectangleBody as RectangleBody
from mesokit.method.mpcd.body.sphere import SphereBody as SphereBody
from mesokit.method.mpcd.body.spheroid import SpheroidBody as SpheroidBody
from mesokit.method.mpcd.body.union import UnionBody as UnionBody
from mesokit.method.mpcd.collision.at import AT as AT
from mesokit.method.mpcd.collision.at_plus_a import ATPlusA as ATPlusA
from mesokit.method.mpcd.collision.demix import Demix as Demix
from mesokit.method.mpcd.collision.none import NoCollision as NoCollision
from mesokit.method.mpcd.collision.protocol import CollisionRule as CollisionRule
from mesokit.method.mpcd.collision.srd import SRD as SRD
from mesokit.method.mpcd.collision.srd_plus_a import SRDPlusA as SRDPlusA
from mesokit.method.mpcd.derived import derive as derive
from mesokit.method.mpcd.field.none import NoForce as NoForce
from mesokit.method.mpcd.field.oscillating import OscillatingForce as OscillatingForce
from mesokit.method.mpcd.field.protocol import Force as Force
from mesokit.method.mpcd.field.sampled import SampledForce as SampledForce
from mesokit.method.mpcd.field.scheduled import ScheduledForce as ScheduledForce
from mesokit.method.mpcd.field.sinusoidal import Sinusoidal as Sinusoidal
from mesokit.method.mpcd.field.uniform import Uniform as Uniform
from mesokit.method.mpcd.fluid import Fluid as Fluid
from mesokit.method.mpcd.fluid import Species as Species
from mesokit.method.mpcd.molecule import Molecule as Molecule
from mesokit.method.mpcd.numbers import Derived as Derived
from mesokit.method.mpcd.observe.body_correlation import BodyCorrelation as BodyCorrelation
from mesokit.method.mpcd.observe.body_displacement import BodyDisplacement as BodyDisplacement
from mesokit.method.mpcd.observe.body_drift import BodyDrift as BodyDrift
from mesokit.method.mpcd.observe.body_flow import BodyFlow as BodyFlow
from mesokit.method.mpcd.observe.body_motion import BodyMotion as BodyMotion
from mesokit.method.mpcd.observe.body_order import BodyOrder as BodyOrder
from mesokit.method.mpcd.observe.body_profile import BodyProfile as BodyProfile
from mesokit.method.mpcd.observe.body_tracks import BodyTracks as BodyTracks
from mesokit.method.mpcd.observe.bond_correlation import BondCorrelation as BondCorrelation
from mesokit.method.mpcd.observe.bond_length import BondLength as BondLength
from mesokit.method.mpcd.observe.cell_occupancy import CellOccupancy as CellOccupancy
from mesokit.method.mpcd.observe.conservation import Conservation as Conservation
from mesokit.method.mpcd.observe.density_field import DensityField as DensityField
from mesokit.method.mpcd.observe.density_gradient import DensityGradient as DensityGradient
from mesokit.method.mpcd.observe.domain_size import DomainSize as DomainSize
from mesokit.method.mpcd.observe.dynamic_moduli import DynamicModuli as DynamicModuli
from mesokit.method.mpcd.observe.flow_rate import FlowRate as FlowRate
from mesokit.method.mpcd.observe.forces import Forces as Forces
from mesokit.method.mpcd.observe.longitudinal_modes import LongitudinalModes as LongitudinalModes
from mesokit.method.mpcd.observe.molecule_histogram import MoleculeHistogram as MoleculeHistogram
from mesokit.method.mpcd.observe.molecule_size import MoleculeSize as MoleculeSize
from mesokit.method.mpcd.observe.molecule_tracks import MoleculeTracks as MoleculeTracks
from mesokit.method.mpcd.observe.normal_modes import NormalModes as NormalModes
from mesokit.method.mpcd.observe.probe import Probe as Probe
from mesokit.method.mpcd.observe.radial_profile import RadialProfile as RadialProfile
from mesokit.method.mpcd.observe.residence_time import ResidenceTime as ResidenceTime
from mesokit.method.mpcd.observe.snapshots import Snapshots as Snapshots
from mesokit.method.mpcd.observe.stress import Stress as Stress
from mesokit.method.mpcd.observe.stress_autocorrelation import (
    StressAutocorrelation as StressAutocorrelation,
)
from mesokit.method.mpcd.observe.stress_in_time import StressInTime as StressInTime
from mesokit.method.mpcd.observe.structure_factor import StructureFactor as StructureFactor
from mesokit.method.mpcd.observe.surface_profile import SurfaceProfile as SurfaceProfile
from mesokit.method.mpcd.observe.transit_time import TransitTime as TransitTime
from mesokit.method.mpcd.observe.translocation_time import TranslocationTime as TranslocationTime
from mesokit.method.mpcd.observe.transverse_modes import TransverseModes as TransverseModes
from mesokit.method.mpcd.observe.velocity_field import VelocityField as VelocityField
from mesokit.method.mpcd.observe.wake import Wake as Wake
from mesokit.method.mpcd.observe.wall_stress import WallStress as WallStress
from mesokit.method.mpcd.si import SI as SI
from mesokit.method.mpcd.si import convert as convert
from mesokit.method.mpcd.solute.external import MagneticField as MagneticField
from mesokit.method.mpcd.solute.external import Pull as Pull
from mesokit.method.mpcd.solute.external import Trap as Trap
from mesokit.method.mpcd.solute.polymer import Between as Between
from mesokit.method.mpcd.solute.polymer import Polymer as Polymer
from mesokit.method.mpcd.solutes import Solutes as Solutes
from mesokit.method.mpcd.start.section import Start as Start
from mesokit.method.mpcd.thermostat.maxwell_boltzmann import MaxwellBoltzmann as MaxwellBoltzmann
from mesokit.method.mpcd.thermostat.none import NoThermostat as NoThermostat
from mesokit.method.mpcd.thermostat.protocol import Thermostat as Thermostat
from mesokit.method.mpcd.thermostat.rescale import Rescale as Rescale
from mesokit.method.spheres.common.kinds import SphereKind as SphereKind
from mesokit.method.spheres.common.observe.cluster_size import ClusterSize as ClusterSize
from mesokit.method.spheres.common.observe.contact_forces import ContactForces as ContactForces
from mesokit.method.spheres.common.observe.contact_network import ContactNetwork as ContactNetwork
from mesokit.method.spheres.common.observe.energy_budget import EnergyBudget as EnergyBudget
from mesokit.method.spheres.common.observe.granular_temperature import (
    GranularTemperature as GranularTemperature,
)
from mesokit.method.spheres.common.observe.height_in_time import HeightInTime as HeightInTime
from mesokit.method.spheres.common.observe.height_profile import HeightProfile as HeightProfile
from mesokit.method.spheres.common.observe.kind_temperature import (
    KindTemperature as KindTemperature,
)
from mesokit.method.spheres.common.observe.outflow import Outflow as Outflow
from mesokit.method.spheres.common.observe.packing_fraction import (
    PackingFraction as PackingFraction,
)
from mesokit.method.spheres.common.observe.repose_angle import ReposeAngle as ReposeAngle
from mesokit.method.spheres.common.observe.run_out import RunOut as RunOut
from mesokit.method.spheres.common.observe.shear_rheology import ShearRheology as ShearRheology
from mesokit.method.spheres.common.observe.velocity_cumulant import (
    VelocityCumulant as VelocityCumulant,
)
from mesokit.method.spheres.common.observe.wall_force import WallForce as WallForce
from mesokit.method.spheres.common.observe.wall_load import WallLoad as WallLoad
from mesokit.method.spheres.common.start.from_file import FileStart as FileStart
from mesokit.method.spheres.common.start.from_file import RunStart as RunStart
from mesokit.method.spheres.common.start.lattice import LatticeStart as LatticeStart
from mesokit.method.spheres.common.start.poured import PouredStart as PouredStart
from mesokit.method.spheres.common.start.protocol import SphereStart as SphereStart
from mesokit.method.spheres.common.start.random import RandomStart as RandomStart
from mesokit.method.spheres.hard.collision.hard import HardCollision as HardCollision
from mesokit.method.spheres.hard.collision.protocol import SphereCollision as SphereCollision
from mesokit.method.spheres.hard.collision.square_well import SquareWell as SquareWell
from mesokit.method.spheres.hard.collision.viscoelastic import Viscoelastic as Viscoelastic
from mesokit.method.spheres.hard.heating.andersen import Andersen as Andersen
from mesokit.method.spheres.hard.heating.kicks import Kicks as Kicks
from mesokit.method.spheres.hard.heating.protocol import Heating as Heating
from mesokit.method.spheres.hard.observe.collision_rate import CollisionRate as CollisionRate
from mesokit.method.spheres.hard.observe.equation_of_state import (
    EquationOfState as EquationOfState,
)
from mesokit.method.spheres.hard.observe.free_times import FreeTimes as FreeTimes
from mesokit.method.spheres.hard.section import HardSpheres as HardSpheres
from mesokit.method.spheres.rigid.law.cohesion import ContactCohesion as ContactCohesion
from mesokit.method.spheres.rigid.law.contact import RigidContact as RigidContact
from mesokit.method.spheres.rigid.observe.plate_motion import PlateMotion as PlateMotion
from mesokit.method.spheres.rigid.observe.solver_residual import (
    SolverResidual as SolverResidual,
)
from mesokit.method.spheres.rigid.section import RigidSpheres as RigidSpheres
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel as GaussSeidel
from mesokit.method.spheres.rigid.solver.jacobi import Jacobi as Jacobi
from mesokit.method.spheres.rigid.solver.protocol import ContactSolver as ContactSolver
from mesokit.method.spheres.soft.observe.contact_stress import ContactStress as ContactStress
from mesokit.method.spheres.soft.pair.hertz import HertzLaw as HertzLaw
from mesokit.method.spheres.soft.pair.protocol import ContactLaw as ContactLaw
from mesokit.method.spheres.soft.pair.protocol import PairLaw as PairLaw
from mesokit.method.spheres.soft.pair.spring_dashpot import SpringDashpot as SpringDashpot
from mesokit.method.spheres.soft.section import SoftSpheres as SoftSpheres
from mesokit.method.spheres.soft.thermostat.langevin import Langevin as Langevin
from mesokit.method.spheres.soft.thermostat.protocol import SoftThermostat as SoftThermostat
from mesokit.method.spheres.soft.thermostat.rescale import RescaleAll as RescaleAll
from mesokit.observe.density_profile import DensityProfile as DensityProfile
from mesokit.observe.flow_frames import FlowFrames as FlowFrames
from mesokit.observe.hexatic_order import HexaticOrder as HexaticOrder
from mesokit.observe.mean_square_displacement import (
    MeanSquareDisplacement as MeanSquareDisplacement,
)
from mesokit.observe.radial_distribution import RadialDistribution as RadialDistribution
from mesokit.observe.temperature_profile import TemperatureProfile as TemperatureProfile
from mesokit.observe.velocity_autocorrelation import (
    VelocityAutocorrelation as VelocityAutocorrelation,
)
from mesokit.observe.velocity_distribution import VelocityDistribution as VelocityDistribution
from mesokit.observe.velocity_profile import VelocityProfile as VelocityProfile
from mesokit.potential.bending import Bending as Bending
from mesokit.potential.fene import FENE as FENE
from mesokit.potential.harmonic import Harmonic as Harmonic
from mesokit.potential.harmonic import Spring as Spring
from mesokit.potential.lennard_jones import LennardJones as LennardJones
from mesokit.potential.protocol import Angle as Angle
from mesokit.potential.protocol import Bond as Bond
from mesokit.potential.protocol import Pair as Pair
from mesokit.potential.table import Table as Table
from mesokit.potential.wca import WCA as WCA
from mesokit.run.callbacks import Callback as Callback
from mesokit.run.callbacks import StopRun as StopRun
from mesokit.run.callbacks import every as every
from mesokit.run.opened import RunFiles as RunFiles
from mesokit.run.opened import open as open
from mesokit.run.simulation import Simulation as Simulation
from mesokit.seam.observable import Observable as Observable
from mesokit.seam.result import Comparison as Comparison
from mesokit.seam.result import Result as Result
from mesokit.study.merge import merge as merge
from mesokit.study.study import Study as Study
