"""What the simulated fluids should obey: one law a file, pure NumPy and SciPy.

Nothing here uses the rest of mesokit, so that it can judge it. Lengths are in cell sides a = 1.
"""

from mesokit.theory.channel_cylinder import Reference, channel_cylinder, square_wake_length
from mesokit.theory.couette import couette_velocity
from mesokit.theory.cubic_array import (
    cubic_array_drag,
    cubic_array_drag_dilute,
    cubic_array_permeability,
)
from mesokit.theory.finite_size import viscosity_renormalised
from mesokit.theory.gamma import cell_energy_cdf, cell_energy_pdf, cell_energy_variance
from mesokit.theory.hagen_poiseuille import (
    hagen_poiseuille_flow_rate,
    hagen_poiseuille_velocity,
)
from mesokit.theory.held_temperature import shear_warming, temperature_offset
from mesokit.theory.kolmogorov import (
    kolmogorov_onset_time,
    kolmogorov_velocity,
    kolmogorov_viscosity,
)
from mesokit.theory.lees_edwards import lees_edwards_relaxation_time, lees_edwards_velocity
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
from mesokit.theory.origin import Origin, origins
from mesokit.theory.poiseuille import PoiseuilleFit, poiseuille_fit, poiseuille_velocity
from mesokit.theory.square_array import (
    square_array_drag,
    square_array_drag_dilute,
    square_array_permeability,
)
from mesokit.theory.taylor_couette import (
    taylor_couette_coefficients,
    taylor_couette_torque,
    taylor_couette_velocity,
)
from mesokit.theory.transport import Transport, transport
from mesokit.theory.transverse_modes import (
    ViscosityFit,
    transverse_correlation,
    transverse_viscosity_fit,
)
from mesokit.theory.velocity_autocorrelation import (
    vacf_modes,
    vacf_molecular_chaos,
    vacf_tail,
)
from mesokit.theory.water import (
    water_density,
    water_diffusion,
    water_sound_speed,
    water_viscosity,
)

__all__ = [
    "Origin",
    "PoiseuilleFit",
    "Reference",
    "Transport",
    "ViscosityFit",
    "cell_energy_cdf",
    "cell_energy_pdf",
    "cell_energy_variance",
    "channel_cylinder",
    "couette_velocity",
    "cubic_array_drag",
    "cubic_array_drag_dilute",
    "cubic_array_permeability",
    "decorrelation_from_diffusion",
    "hagen_poiseuille_flow_rate",
    "hagen_poiseuille_velocity",
    "kolmogorov_onset_time",
    "kolmogorov_velocity",
    "kolmogorov_viscosity",
    "lees_edwards_relaxation_time",
    "lees_edwards_velocity",
    "maxwell_component_cdf",
    "maxwell_component_pdf",
    "maxwell_speed_cdf",
    "maxwell_speed_pdf",
    "msd_molecular_chaos",
    "origins",
    "poiseuille_fit",
    "poiseuille_velocity",
    "shear_warming",
    "square_array_drag",
    "square_array_drag_dilute",
    "square_array_permeability",
    "square_wake_length",
    "taylor_couette_coefficients",
    "taylor_couette_torque",
    "taylor_couette_velocity",
    "temperature_offset",
    "transport",
    "transverse_correlation",
    "transverse_viscosity_fit",
    "vacf_modes",
    "vacf_molecular_chaos",
    "vacf_tail",
    "viscosity_renormalised",
    "water_density",
    "water_diffusion",
    "water_sound_speed",
    "water_viscosity",
]
