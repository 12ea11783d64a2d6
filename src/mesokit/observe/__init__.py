"""Observables. A new one is a file here and a name in `AnyObservable`: one file, one line."""

from __future__ import annotations

from typing import get_args

from mesokit.observe.bond_length import BondLength
from mesokit.observe.conservation import Conservation
from mesokit.observe.density_field import DensityField
from mesokit.observe.density_profile import DensityProfile
from mesokit.observe.dynamic_moduli import DynamicModuli
from mesokit.observe.flow_frames import FlowFrames
from mesokit.observe.flow_rate import FlowRate
from mesokit.observe.forces import Forces
from mesokit.observe.longitudinal_modes import LongitudinalModes
from mesokit.observe.mean_square_displacement import MeanSquareDisplacement
from mesokit.observe.molecule_size import MoleculeSize
from mesokit.observe.normal_modes import NormalModes
from mesokit.observe.probe import Probe
from mesokit.observe.protocol import Accumulator, Observable, RunningFluid
from mesokit.observe.radial_profile import RadialProfile
from mesokit.observe.result import Comparison, Result
from mesokit.observe.stress import Stress
from mesokit.observe.stress_autocorrelation import StressAutocorrelation
from mesokit.observe.surface_profile import SurfaceProfile
from mesokit.observe.temperature_profile import TemperatureProfile
from mesokit.observe.transverse_modes import TransverseModes
from mesokit.observe.velocity_autocorrelation import VelocityAutocorrelation
from mesokit.observe.velocity_field import VelocityField
from mesokit.observe.velocity_profile import VelocityProfile
from mesokit.observe.wake import Wake
from mesokit.observe.wall_stress import WallStress

AnyObservable = (
    Conservation
    | VelocityProfile
    | DensityProfile
    | TemperatureProfile
    | VelocityField
    | DensityField
    | FlowFrames
    | MeanSquareDisplacement
    | VelocityAutocorrelation
    | TransverseModes
    | MoleculeSize
    | NormalModes
    | LongitudinalModes
    | WallStress
    | Stress
    | DynamicModuli
    | StressAutocorrelation
    | Forces
    | FlowRate
    | RadialProfile
    | SurfaceProfile
    | Wake
    | Probe
    | BondLength
)
OBSERVABLES: tuple[type, ...] = get_args(AnyObservable)

__all__ = [
    "OBSERVABLES",
    "Accumulator",
    "AnyObservable",
    "BondLength",
    "Comparison",
    "Conservation",
    "DensityField",
    "DensityProfile",
    "DynamicModuli",
    "FlowFrames",
    "FlowRate",
    "Forces",
    "LongitudinalModes",
    "MeanSquareDisplacement",
    "MoleculeSize",
    "NormalModes",
    "Observable",
    "Probe",
    "RadialProfile",
    "Result",
    "RunningFluid",
    "Stress",
    "StressAutocorrelation",
    "SurfaceProfile",
    "TemperatureProfile",
    "TransverseModes",
    "VelocityAutocorrelation",
    "VelocityField",
    "VelocityProfile",
    "Wake",
    "WallStress",
]
