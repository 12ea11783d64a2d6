"""Fluids of every kind of step, small: for what holds for each of them, such as the same bits."""

from mesokit import (
    AT,
    FENE,
    SRD,
    WCA,
    ATPlusA,
    Bending,
    Demix,
    Disk,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    Plates,
    Polymer,
    SampledForce,
    Solutes,
    Species,
    Spring,
    Surface,
    Uniform,
)
from mesokit.method.mpcd.solute.polymer import Between
from tests.helpers.small_fluids import file_of_a_wave, fingerprint

PUSHED_SLIT = {
    "thermostat": MaxwellBoltzmann(), "force": Uniform(acceleration=(0.05, -0.02)),
    "walls": [Plates(axis="y", upper=Surface(velocity=(0.3, 0.0)))], "measures": ("walls",),
}  # fmt: skip
PARTICLES = {
    "slit with an odd number of particles": PUSHED_SLIT | {
        "size": (13, 7), "density": 9.527, "collision": SRD(angle=90),
    },
    "sheared box": {
        "size": (5, 11, 6), "density": 7.01, "thermostat": MaxwellBoltzmann(), "shear_rate": 0.2,
    },
    "mixture": {
        "size": (11, 6), "species": (Species(mass=1, density=4), Species(mass=5, density=3)),
    },
    "demixing species": {
        "size": (20, 20), "species": (Species(mass=1, density=5), Species(mass=1, density=5)),
        "collision": Demix(0.05),
    },
    "force at nodes": {
        "size": (12, 5, 6), "density": 5, "collision": AT(),
        "force": SampledForce(file_of_a_wave(3)),
    },
}  # fmt: skip

SHEARED = {
    "size": (5, 11, 6), "density": 2310 / 330, "shear_rate": 0.2,
    "molecule": Molecule(length=7, bond=Harmonic(K=1.0), substeps=2),
    "thermostat": MaxwellBoltzmann(),
}  # fmt: skip
MOLECULES = {
    "dimers in a slit": PUSHED_SLIT | {
        "size": (13, 7), "density": 1778 / 91,
        "molecule": Molecule(bond=Harmonic(K=1.0), substeps=3),
    },
    "sheared chains": SHEARED,
    "chains whose shear oscillates": SHEARED | {"shear_frequency": 0.3},
    "stars about a disk": {
        "size": (16, 12), "density": 8, "thermostat": MaxwellBoltzmann(),
        "molecule": Molecule(topology="star", length=4, arms=3, bond=Harmonic(K=1.0), substeps=2),
        "force": Uniform(acceleration=(0.05, -0.02)),
        "walls": [Disk(centre=(8, 6), radius=3, surface=Surface("diffuse"))],
    },
}  # fmt: skip

DISSOLVED = {
    "sheared solutes": {
        "size": (12, 12, 12), "density": 2, "shear_rate": 0.2, "thermostat": MaxwellBoltzmann(),
        "solutes": Solutes((Polymer(600), Polymer(20, length=9)), mass=3.0, bond=FENE(),
                           bending=Bending(kappa=2.0), pair=WCA(), substeps=30),
    },
    "solutes and a rule that draws": {
        "size": (30, 30), "density": 2, "collision": ATPlusA(),
        "solutes": Solutes((Polymer(800),), mass=4.0),
    },
}  # fmt: skip

# potentials of their own, given, mixed and missing ones
SEVERAL_KINDS = Solutes(
    (
        Polymer(4, length=5, name="chain", mass=2.0, bond=Harmonic(K=2.0),
                bending=Bending(kappa=3.0)),
        Polymer(3, length=4, topology="ring", mass=5.0, pair=WCA(sigma=0.5),
                bond=Spring(k=30.0, length=0.7)),
        Polymer(8, name="ball", mass=20.0, pair=WCA(sigma=1.3, epsilon=2.0)),
    ),
    between=[Between(["chain", "ball"], WCA(sigma=0.8))],
    substeps=20,
)  # fmt: skip
EMBEDDED = Solutes(
    (Polymer(8),), mass=20.0, coupling="potential", solvent_pair=WCA(sigma=1.5), substeps=8
)
DIMERS = Molecule(bond=Harmonic(K=1.0), substeps=4)
FEW = Solutes((Polymer(20, length=4),), mass=3.0, bond=Harmonic(K=1.0), substeps=8)
# of other masses than the fluid, and their own
OF_MANY_MASSES = Solutes(
    (Polymer(60, length=4), Polymer(8, length=3, topology="ring"), Polymer(12, mass=12.0)),
    mass=3.0, bond=Harmonic(K=1.0), substeps=8,
)  # fmt: skip
AMONG_MOLECULES = {
    "bulk": {"size": (8, 8, 8), "density": 10, "molecule": DIMERS, "solutes": OF_MANY_MASSES},
    "exact dimers": {
        "size": (7, 6, 8), "density": 10, "thermostat": MaxwellBoltzmann(), "solutes": FEW,
        "molecule": Molecule(bond=Harmonic(K=1.0), propagation="exact"),
    },
    "slit": {
        "size": (13, 7), "density": 1764 / 91, "thermostat": MaxwellBoltzmann(),
        "molecule": Molecule(length=3, bond=Harmonic(K=1.0), substeps=3), "measures": ("walls",),
        "walls": [Plates(axis="y", upper=Surface(velocity=(0.3, 0.0)))], "solutes": FEW,
    },
    "sheared": {
        "size": (12, 20), "density": 9, "shear_rate": 0.1, "thermostat": MaxwellBoltzmann(),
        "molecule": Molecule(length=3, bond=Harmonic(K=1.0), substeps=3), "solutes": FEW,
    },
}  # fmt: skip


def everything(fluid):
    """All that can be read of a fluid and of its solutes."""
    if not fluid.solutes:
        return fingerprint(fluid)
    solutes = fluid.solutes.places, fluid.solutes.velocities, fluid.potential_energy()
    return [*fingerprint(fluid), *solutes]
