"""Temperature that a thermostat of the collision cells holds, where it is not quite kT."""

import numpy as np

from mesokit.theory._check import dimension_two_or_three, one_of, positive
from mesokit.theory.srd_angular_table import cell_table, rigid_share
from mesokit.theory.transport import Angle, Rule, Thermostat, cell_memory, transport


def shear_warming(
    rule: Rule,
    dimension: int,
    density: float,
    timestep: float,
    angle: Angle = None,
    kT: float = 1.0,
    mass: float = 1.0,
    thermostat: Thermostat = "none",
) -> float:
    """w in T = kT + w m rate^2: the temperature about the linear profile of a held, sheared fluid.

    Parameters as in `transport`; the result is in units of the cell side squared. The cell
    thermostat sets the energy of the n particles about the motion that the rule conserves, the
    shear in the cell included. The temperature is that of velocities about the linear profile:
        w = [(1 - 2 r) <A> + (2 dt nu_kin/d) <d n - f>]/<f>,
    A = (n - 1)/12 (q/(1 - r1) for the rules +a) the square of the shear in the cell, f the degrees
    of freedom that are set, r = r1 s1 what the collision keeps of a velocity. The first term is
    w = (1 - 2 r)/(12 d) for srd and at; the second is the friction of one flight, which the
    conserved motions have not lost.

    Raises ValueError as `transport`, and for a fluid that nothing holds. Source: derived in
    docs/theory.md, equation (6), molecular chaos. Correlations of particles that meet again add
    0.003 to 0.02: measured at density 10, rates 0.2 to 0.5, timesteps 0.1 and 1, all rules.

    >>> round(shear_warming("at", 3, 10, 1e-6), 4)  # 1/36 at a small timestep
    0.0278
    """
    given = (rule, dimension, density, timestep, angle, kT, mass, thermostat)
    friction = 2 * timestep * transport(*given).viscosity_kinetic / dimension
    if rule.startswith("srd") and thermostat == "none":
        raise ValueError("thermostat = 'none': expected one that holds the temperature")
    n, p, kept, _ = cell_memory(dimension, density, angle, rule, thermostat)
    if rule.endswith("+a"):
        rank = np.rint(dimension * n * rigid_share(dimension, n))
        sheared = cell_table(dimension, n)[1]
    else:
        rank = np.full_like(n, dimension)
        sheared = (n - 1) / 12
    free = dimension * n - rank
    warmed = (1 - 2 * kept) * sheared + friction * rank
    return float(np.sum(p * warmed) / np.sum(p * free))


def temperature_offset(
    rule: Rule, thermostat: Thermostat, dimension: int, density: float, mean_free_path: float
) -> float:
    """Largest known (T - kT)/kT of a held fluid at rest: positive reads warm, negative cold.

    Parameters: `rule`, `thermostat`, `dimension`, `density` as in `transport`; `mean_free_path` in
    cells. At molecular chaos T is kT for every rule and thermostat, and `at`, `at+a` and `srd` with
    "maxwell-boltzmann" leave the canonical distribution alone. "rescale" does not (it allows no
    fluctuation of a cell's energy), nor does "srd+a" (its rotation mixes rigid and free motion
    before it scales); where particles meet again, that changes T.

    Raises ValueError for a value out of range. Source: a bound on what was measured for
    docs/theory.md (densities 1.5 to 20, mean free paths 0.02 to 4, angles 60 to 130 degrees):
    -0.16/M in 2D and -0.065/M in 3D for "rescale", 0.026 M^(-3/2) for "srd+a" with
    "maxwell-boltzmann"; at mean free paths of 2 and more 0, by molecular chaos (measured at 4).

    >>> round(temperature_offset("srd", "rescale", 3, 10, 0.1), 6)
    -0.0065
    """
    one_of(("srd", "srd+a", "at", "at+a"), rule=rule)
    one_of(("none", "maxwell-boltzmann", "rescale"), thermostat=thermostat)
    dimension_two_or_three(dimension)
    positive(density=density, mean_free_path=mean_free_path)
    if mean_free_path >= 2 or rule.startswith("at"):
        return 0.0
    if thermostat == "rescale":
        return -(0.16 if dimension == 2 else 0.065) / density
    return 0.026 * density**-1.5 if (rule, thermostat) == ("srd+a", "maxwell-boltzmann") else 0.0
