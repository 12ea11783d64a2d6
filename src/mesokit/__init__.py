"""Mesoscale particle simulation: fluids by multi-particle collision dynamics.

The public names are imported when they are first used, so that `import mesokit` is instant.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from mesokit import theory
    from mesokit.box import Box
    from mesokit.case import Case
    from mesokit.derived import Derived, derive
    from mesokit.errors import CaseError, CheckpointError, MesokitError, RunError
    from mesokit.geometry import (
        Array,
        Capsule,
        CosineChannel,
        Cuboid,
        Cylinder,
        Disk,
        HalfSpace,
        Intersection,
        Mesh,
        Picture,
        Plates,
        Rectangle,
        Sampled,
        Sphere,
        Surface,
        Union,
    )
    from mesokit.io.open import RunFiles
    from mesokit.io.open import open_run as open
    from mesokit.io.trajectory import Trajectory
    from mesokit.mpcd.collision import AT, SRD, ATPlusA, SRDPlusA
    from mesokit.mpcd.field import NoForce, Sinusoidal, Uniform
    from mesokit.mpcd.fluid import Fluid
    from mesokit.mpcd.initial import Start
    from mesokit.mpcd.molecule import Molecule
    from mesokit.mpcd.solutes import Polymer, Solutes
    from mesokit.mpcd.species import Species
    from mesokit.mpcd.thermostat import MaxwellBoltzmann, NoThermostat, Rescale
    from mesokit.observe import (
        BondLength,
        Comparison,
        Conservation,
        DensityField,
        DensityProfile,
        DynamicModuli,
        FlowFrames,
        FlowRate,
        Forces,
        LongitudinalModes,
        MeanSquareDisplacement,
        MoleculeSize,
        NormalModes,
        Probe,
        RadialProfile,
        Result,
        Stress,
        StressAutocorrelation,
        SurfaceProfile,
        TemperatureProfile,
        TransverseModes,
        VelocityAutocorrelation,
        VelocityField,
        VelocityProfile,
        Wake,
        WallStress,
    )
    from mesokit.potential import FENE, WCA, Bending, Harmonic, LennardJones, Spring
    from mesokit.run import Run
    from mesokit.si import SI, convert
    from mesokit.simulation import Simulation
    from mesokit.solids import Solids
    from mesokit.units import OtherFluid, Units, Water

_PLACES = {  # module: the public names in it
    "mesokit.box": ("Box",),
    "mesokit.case": ("Case",),
    "mesokit.derived": ("Derived", "derive"),
    "mesokit.errors": ("CaseError", "CheckpointError", "MesokitError", "RunError"),
    "mesokit.geometry": (
        "Array",
        "Capsule",
        "CosineChannel",
        "Cuboid",
        "Cylinder",
        "Disk",
        "HalfSpace",
        "Intersection",
        "Mesh",
        "Picture",
        "Plates",
        "Polymer",
        "Rectangle",
        "Sampled",
        "Sphere",
        "Surface",
        "Union",
    ),
    "mesokit.io.open": ("RunFiles",),
    "mesokit.io.trajectory": ("Trajectory",),
    "mesokit.mpcd.collision": ("AT", "ATPlusA", "SRD", "SRDPlusA"),
    "mesokit.mpcd.field": ("NoForce", "Sinusoidal", "Uniform"),
    "mesokit.mpcd.fluid": ("Fluid",),
    "mesokit.mpcd.initial": ("Start",),
    "mesokit.mpcd.molecule": ("Molecule",),
    "mesokit.mpcd.solutes": ("Polymer", "Solutes"),
    "mesokit.mpcd.species": ("Species",),
    "mesokit.mpcd.thermostat": ("MaxwellBoltzmann", "NoThermostat", "Rescale"),
    "mesokit.observe": (
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
        "Probe",
        "RadialProfile",
        "Result",
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
    ),
    "mesokit.potential": ("FENE", "WCA", "Bending", "Harmonic", "LennardJones", "Spring"),
    "mesokit.run": ("Run",),
    "mesokit.si": ("SI", "convert"),
    "mesokit.simulation": ("Simulation",),
    "mesokit.solids": ("Solids",),
    "mesokit.units": ("OtherFluid", "Units", "Water"),
}
_HOME = {name: (module, name) for module, names in _PLACES.items() for name in names}
_HOME["open"] = ("mesokit.io.open", "open_run")

__all__ = [
    "AT",
    "FENE",
    "SI",
    "SRD",
    "WCA",
    "ATPlusA",
    "Array",
    "Bending",
    "BondLength",
    "Box",
    "Capsule",
    "Case",
    "CaseError",
    "CheckpointError",
    "Comparison",
    "Conservation",
    "CosineChannel",
    "Cuboid",
    "Cylinder",
    "DensityField",
    "DensityProfile",
    "Derived",
    "Disk",
    "DynamicModuli",
    "FlowFrames",
    "FlowRate",
    "Fluid",
    "Forces",
    "HalfSpace",
    "Harmonic",
    "Intersection",
    "LennardJones",
    "LongitudinalModes",
    "MaxwellBoltzmann",
    "MeanSquareDisplacement",
    "Mesh",
    "MesokitError",
    "Molecule",
    "MoleculeSize",
    "NoForce",
    "NoThermostat",
    "NormalModes",
    "OtherFluid",
    "Picture",
    "Plates",
    "Polymer",
    "Probe",
    "RadialProfile",
    "Rectangle",
    "Rescale",
    "Result",
    "Run",
    "RunError",
    "RunFiles",
    "SRDPlusA",
    "Sampled",
    "Simulation",
    "Sinusoidal",
    "Solids",
    "Solutes",
    "Species",
    "Sphere",
    "Spring",
    "Start",
    "Stress",
    "StressAutocorrelation",
    "Surface",
    "SurfaceProfile",
    "TemperatureProfile",
    "Trajectory",
    "TransverseModes",
    "Uniform",
    "Union",
    "Units",
    "VelocityAutocorrelation",
    "VelocityField",
    "VelocityProfile",
    "Wake",
    "WallStress",
    "Water",
    "convert",
    "derive",
    "open",
    "theory",
]


def __getattr__(name: str) -> Any:
    if name == "theory":
        return importlib.import_module("mesokit.theory")
    if name in _HOME:
        module, inside = _HOME[name]
        value = getattr(importlib.import_module(module), inside)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'mesokit' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
