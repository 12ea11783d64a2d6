"""What the simulated fluids should obey: one law a file, pure NumPy and SciPy.

Nothing here uses the rest of mesokit, so that it can judge it. Lengths are in cell sides a = 1.
"""

from mesokit.theory.barometric import barometric_cdf, barometric_mean
from mesokit.theory.bead_diffusion import bead_diffusion
from mesokit.theory.bond_correlation import BondCorrelation, bond_correlation
from mesokit.theory.chain_diffusion import (
    kirkwood_diffusion,
    kirkwood_in_cells,
    rouse_diffusion,
    zimm_diffusion,
)
from mesokit.theory.chain_displacement import msd_rouse_beads
from mesokit.theory.chain_distribution import cosine_cdf, end_to_end_cdf, gyration_cdf
from mesokit.theory.chain_in_slit import beads_in_slit, centre_in_slit
from mesokit.theory.chain_scaling import ChainExponents, chain_exponents
from mesokit.theory.chain_size import mean_square_end_to_end, mean_square_gyration
from mesokit.theory.channel_cylinder import Reference, channel_cylinder, square_wake_length
from mesokit.theory.collapse_in_a_line import collapse_restitution
from mesokit.theory.couette import couette_velocity
from mesokit.theory.cubic_array import (
    cubic_array_drag,
    cubic_array_drag_dilute,
    cubic_array_permeability,
)
from mesokit.theory.demixing import demixing_coupling, demixing_diffusion
from mesokit.theory.diffusion_in_box import diffusion_in_box
from mesokit.theory.dumbbell_shear import (
    dumbbell_viscosity,
    fene_p_thinning,
    pair_friction,
)
from mesokit.theory.elastic_share import elastic_share
from mesokit.theory.enskog_diffusion import enskog_diffusion
from mesokit.theory.enskog_rate import contact_value, enskog_rate
from mesokit.theory.finite_size import viscosity_renormalised
from mesokit.theory.fourth_cumulant import fourth_cumulant
from mesokit.theory.free_time import collision_speeds, free_time_cdf, free_time_spread
from mesokit.theory.gamma import cell_energy_cdf, cell_energy_pdf, cell_energy_variance
from mesokit.theory.gaussian_structure_factor import gaussian_structure_factor
from mesokit.theory.haff import haff_temperature, haff_time
from mesokit.theory.hagen_poiseuille import (
    hagen_poiseuille_flow_rate,
    hagen_poiseuille_velocity,
)
from mesokit.theory.hard_sphere_pressure import (
    compressibility,
    compressibility_of_few,
    mean_speed_factor,
)
from mesokit.theory.harmonic_spring import Spring, mean_square_bond, spring, spring_of_bond
from mesokit.theory.harmonic_trap import TrappedShape, normal_in_box, trapped_shape
from mesokit.theory.heading_memory import angular_memory, vectorial_memory
from mesokit.theory.heat_at_walls import HeatAtWalls, heat_at_walls, slit_temperature_rise
from mesokit.theory.held_temperature import shear_warming, temperature_offset
from mesokit.theory.hertz_contact import hertz_contact
from mesokit.theory.hookean_shear import (
    ShearStress,
    SizeInShear,
    dumbbell_thinning,
    maxwell_shear,
    shear_heating,
    size_in_shear,
)
from mesokit.theory.kicked_temperature import kicked_temperature
from mesokit.theory.kolmogorov import (
    kolmogorov_onset_time,
    kolmogorov_velocity,
    kolmogorov_viscosity,
)
from mesokit.theory.kremer_grest import BondLength, kremer_grest_bond
from mesokit.theory.lees_edwards import lees_edwards_relaxation_time, lees_edwards_velocity
from mesokit.theory.lennard_jones_tail import LennardJonesTail, lennard_jones_tail
from mesokit.theory.maxwell import (
    maxwell_component_cdf,
    maxwell_component_pdf,
    maxwell_speed_cdf,
    maxwell_speed_pdf,
)
from mesokit.theory.mean_square_displacement import (
    decorrelation_from_diffusion,
    msd_molecular_chaos,
)
from mesokit.theory.mixture_pressure import mixture_compressibility
from mesokit.theory.normal_modes import (
    NormalModes,
    linear_modes,
    network_modes,
    ring_modes,
    star_modes,
)
from mesokit.theory.origin import Origin, origins
from mesokit.theory.oscillating_slit import oscillating_slit_response, oscillating_slit_velocity
from mesokit.theory.passage_times import first_passage_cdf, mean_exit_time
from mesokit.theory.persistent_walk import msd_persistent_walk, persistent_diffusion
from mesokit.theory.ping_pong import (
    bounce_height,
    bounce_path,
    bounce_time,
    dissipative_bounces,
    lossy_bounces,
)
from mesokit.theory.poiseuille import PoiseuilleFit, poiseuille_fit, poiseuille_velocity
from mesokit.theory.polar_order import (
    CrowdOrder,
    disordered_binder,
    disordered_order,
    mean_square_order,
    vectorial_order,
)
from mesokit.theory.pulled_shape import pulled_shape
from mesokit.theory.relaxation_modulus import (
    apparent_viscosity,
    complex_viscosity,
    loss_modulus,
    relaxation_modulus,
    storage_modulus,
)
from mesokit.theory.rouse_times import RouseTimes, rouse_times, rouse_times_from_slowest
from mesokit.theory.second_virial import second_virial
from mesokit.theory.self_diffusion import self_diffusion
from mesokit.theory.slip_sphere import enskog_friction, slip_sphere_diffusion
from mesokit.theory.slope import EndOfSliding, Rolling, down_slope, end_of_sliding
from mesokit.theory.sonine import sonine_component_cdf, sonine_speed_cdf
from mesokit.theory.spring_dashpot import spring_dashpot
from mesokit.theory.square_array import (
    square_array_drag,
    square_array_drag_dilute,
    square_array_permeability,
)
from mesokit.theory.stress_in_time import StressInTime, stress_in_time
from mesokit.theory.taylor_couette import (
    taylor_couette_coefficients,
    taylor_couette_torque,
    taylor_couette_velocity,
)
from mesokit.theory.transport import Transport, transport
from mesokit.theory.transverse_chain import (
    TransversePoles,
    transverse_correlation_chain,
    transverse_poles,
)
from mesokit.theory.transverse_dimer import dimer_oscillation_range, transverse_correlation_dimer
from mesokit.theory.transverse_finite_k import (
    GaussianMolecule,
    gaussian_stress_kernel,
    transverse_correlation_finite_k,
)
from mesokit.theory.transverse_modes import (
    ViscosityFit,
    transverse_correlation,
    transverse_viscosity_fit,
)
from mesokit.theory.trimer import trimer_bond_length, trimer_spring_constant
from mesokit.theory.velocity_autocorrelation import (
    vacf_modes,
    vacf_molecular_chaos,
    vacf_tail,
)
from mesokit.theory.verlet_swing import verlet_swing
from mesokit.theory.virtual_gas_slip import virtual_gas_slip
from mesokit.theory.water import (
    water_density,
    water_diffusion,
    water_sound_speed,
    water_viscosity,
)
from mesokit.theory.zimm_shear import ChainInShear, zimm_shear
from mesokit.theory.zimm_times import zimm_times

__all__ = [
    "BondCorrelation",
    "BondLength",
    "ChainExponents",
    "ChainInShear",
    "CrowdOrder",
    "EndOfSliding",
    "GaussianMolecule",
    "HeatAtWalls",
    "LennardJonesTail",
    "NormalModes",
    "Origin",
    "PoiseuilleFit",
    "Reference",
    "Rolling",
    "RouseTimes",
    "ShearStress",
    "SizeInShear",
    "Spring",
    "StressInTime",
    "Transport",
    "TransversePoles",
    "TrappedShape",
    "ViscosityFit",
    "angular_memory",
    "apparent_viscosity",
    "barometric_cdf",
    "barometric_mean",
    "bead_diffusion",
    "beads_in_slit",
    "bond_correlation",
    "bounce_height",
    "bounce_path",
    "bounce_time",
    "cell_energy_cdf",
    "cell_energy_pdf",
    "cell_energy_variance",
    "centre_in_slit",
    "chain_exponents",
    "channel_cylinder",
    "collapse_restitution",
    "collision_speeds",
    "complex_viscosity",
    "compressibility",
    "compressibility_of_few",
    "contact_value",
    "cosine_cdf",
    "couette_velocity",
    "cubic_array_drag",
    "cubic_array_drag_dilute",
    "cubic_array_permeability",
    "decorrelation_from_diffusion",
    "demixing_coupling",
    "demixing_diffusion",
    "diffusion_in_box",
    "dimer_oscillation_range",
    "disordered_binder",
    "disordered_order",
    "dissipative_bounces",
    "down_slope",
    "dumbbell_thinning",
    "dumbbell_viscosity",
    "elastic_share",
    "end_of_sliding",
    "end_to_end_cdf",
    "enskog_diffusion",
    "enskog_friction",
    "enskog_rate",
    "fene_p_thinning",
    "first_passage_cdf",
    "fourth_cumulant",
    "free_time_cdf",
    "free_time_spread",
    "gaussian_stress_kernel",
    "gaussian_structure_factor",
    "gyration_cdf",
    "haff_temperature",
    "haff_time",
    "hagen_poiseuille_flow_rate",
    "hagen_poiseuille_velocity",
    "heat_at_walls",
    "hertz_contact",
    "kicked_temperature",
    "kirkwood_diffusion",
    "kirkwood_in_cells",
    "kolmogorov_onset_time",
    "kolmogorov_velocity",
    "kolmogorov_viscosity",
    "kremer_grest_bond",
    "lees_edwards_relaxation_time",
    "lees_edwards_velocity",
    "lennard_jones_tail",
    "linear_modes",
    "loss_modulus",
    "lossy_bounces",
    "maxwell_component_cdf",
    "maxwell_component_pdf",
    "maxwell_shear",
    "maxwell_speed_cdf",
    "maxwell_speed_pdf",
    "mean_exit_time",
    "mean_speed_factor",
    "mean_square_bond",
    "mean_square_end_to_end",
    "mean_square_gyration",
    "mean_square_order",
    "mixture_compressibility",
    "msd_molecular_chaos",
    "msd_persistent_walk",
    "msd_rouse_beads",
    "network_modes",
    "normal_in_box",
    "origins",
    "oscillating_slit_response",
    "oscillating_slit_velocity",
    "pair_friction",
    "persistent_diffusion",
    "poiseuille_fit",
    "poiseuille_velocity",
    "pulled_shape",
    "relaxation_modulus",
    "ring_modes",
    "rouse_diffusion",
    "rouse_times",
    "rouse_times_from_slowest",
    "second_virial",
    "self_diffusion",
    "shear_heating",
    "shear_warming",
    "size_in_shear",
    "slip_sphere_diffusion",
    "slit_temperature_rise",
    "sonine_component_cdf",
    "sonine_speed_cdf",
    "spring",
    "spring_dashpot",
    "spring_of_bond",
    "square_array_drag",
    "square_array_drag_dilute",
    "square_array_permeability",
    "square_wake_length",
    "star_modes",
    "storage_modulus",
    "stress_in_time",
    "taylor_couette_coefficients",
    "taylor_couette_torque",
    "taylor_couette_velocity",
    "temperature_offset",
    "transport",
    "transverse_correlation",
    "transverse_correlation_chain",
    "transverse_correlation_dimer",
    "transverse_correlation_finite_k",
    "transverse_poles",
    "transverse_viscosity_fit",
    "trapped_shape",
    "trimer_bond_length",
    "trimer_spring_constant",
    "vacf_modes",
    "vacf_molecular_chaos",
    "vacf_tail",
    "vectorial_memory",
    "vectorial_order",
    "verlet_swing",
    "virtual_gas_slip",
    "viscosity_renormalised",
    "water_density",
    "water_diffusion",
    "water_sound_speed",
    "water_viscosity",
    "zimm_diffusion",
    "zimm_shear",
    "zimm_times",
]
