"""What `mesokit theory` says of fluids of chains."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from mesokit import theory
from mesokit.case.amounts import number
from mesokit.errors import CaseError

Row = tuple[str, str, str]
ROUSE = "approximate: Rouse, beads with the friction of single particles"
SAME = "the numbers above are those of the same fluid without bonds"


@dataclass(frozen=True)
class Beads:
    """What chains are made of: particles of a fluid.

    `stirring` is the self-diffusion of a single one with what it stirs up (of molecular chaos in
    2D, where it depends on the box), `mass_density` that of the fluid, `viscosity` its kinematic
    one without bonds.
    """

    dimension: int
    kT: float
    density: float
    mass_density: float
    viscosity: float
    stirring: float

    @property
    def friction(self) -> float:
        """Of a single one."""
        return self.kT / self.stirring

    @property
    def eta(self) -> float:
        """The dynamic viscosity without bonds."""
        return self.viscosity * self.mass_density

    @property
    def radius(self) -> float:
        """The hydrodynamic radius."""
        return self.friction / (6 * math.pi * self.eta)


@dataclass(frozen=True)
class Chain:
    """A chain of so many beads and springs U = K r^2, and its times by Rouse."""

    length: int
    K: float
    times: theory.RouseTimes


def beads_of(found: theory.Transport, given: dict[str, Any]) -> Beads:
    """Those of the fluid that the options describe."""
    stirring = found.diffusion
    kT, density, mass = given["kT"], given["density"], given["mass"]
    if given["dimension"] == 3 and found.mean_free_path < 1:
        stirring = theory.self_diffusion(3, stirring, found.viscosity, density, None, kT, mass)
    return Beads(given["dimension"], kT, density, density * mass, found.viscosity, stirring)


def chains_of(
    beads: Beads, lengths: tuple[int, ...], K: tuple[float, ...], times: tuple[float, ...]
) -> list[Chain]:
    """Every length with every spring, springs by K or by the slowest stress time that they make.

    Raises CaseError for options that do not go together.
    """
    if not lengths and not K and not times:
        return []
    for name, values in (("K", K), ("stress-time", times)):
        if values and not lengths:
            raise CaseError(f"--{name}: only with --length; give both for a fluid of chains")
        for value in values:
            if not 0 < value < math.inf:
                raise CaseError(f"--{name} = {value:g}: expected a finite number above 0")
    if bool(K) == bool(times):
        raise CaseError("--length: expected --K or --stress-time with it, and not both")
    found = []
    for length in lengths:
        modes = theory.linear_modes(length)
        slowest = float(theory.rouse_times(modes, beads.friction, K=1.0).stress[0])
        for stiffness in K or [slowest / time for time in times]:
            rouse = theory.rouse_times(modes, beads.friction, K=stiffness)
            found.append(Chain(length, stiffness, rouse))
    return found


def rows_of(chain: Chain, beads: Beads, frequencies: tuple[float, ...]) -> list[Row]:
    """Times, moduli and viscosity of a fluid that is all chains of a kind."""
    times, K = chain.times, chain.K
    modulus = beads.density / chain.length * beads.kT
    bonds = modulus * float(times.stress.sum())
    square = theory.mean_square_bond(K=K, dimension=beads.dimension, kT=beads.kT)
    force = "m/time^2" if beads.dimension == 2 else "m/(a time^2)"
    rows = [
        (f"chains of {chain.length}", f"K = {K:.4g} kT/a^2", SAME),
        ("mean square bond", number(square, "a^2"), "Boltzmann"),
        ("end to end, squared", number((chain.length - 1) * square, "a^2"), "ideal chain"),
        ("slowest mode time", number(float(times.mode[0]), "time"), ROUSE),
        *_hydrodynamic(chain, beads, math.sqrt(square)),
        (
            "slowest stress time",
            number(float(times.stress[0]), "time"),
            "half of Rouse's",
        ),
        ("modulus", number(modulus, force), "kT for each molecule in a volume"),
        ("viscosity of bonds", number(bonds / beads.mass_density, "a^2/time"), "slow flow"),
        (
            "kinematic viscosity",
            number((beads.eta + bonds) / beads.mass_density, "a^2/time"),
            "with the bonds",
        ),
    ]
    for w in frequencies:
        at = f"at the frequency {w:g}/time"
        stored = theory.storage_modulus(w, modulus, times.stress)
        lost = theory.loss_modulus(w, modulus, times.stress, beads.eta)
        rows.append(("storage modulus", number(float(stored), force), at))
        rows.append(("loss modulus", number(float(lost), force), at))
    return rows


def _hydrodynamic(chain: Chain, beads: Beads, bond: float) -> list[Row]:
    """The slowest mode time of one chain in a fluid of single particles (3D)."""
    if beads.dimension == 2:
        return []
    try:
        zimm = theory.zimm_times(chain.length, beads.friction, beads.eta, bond, beads.kT)
    except ValueError:  # bonds shorter than beads are large
        return []
    note = "approximate: Zimm, one chain in a simple fluid"
    return [("with hydrodynamics", number(float(zimm.mode[0]), "time"), note)]
