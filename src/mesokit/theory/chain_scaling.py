"""How size, diffusion and relaxation of long chains depend on their number of beads."""

from typing import NamedTuple

from mesokit.theory._check import one_of

# dimension, solvent: exponent of the size
FLORY = {
    (2, "theta"): 4 / 7,  # B. Duplantier and H. Saleur, Phys. Rev. Lett. 59, 539 (1987)
    (3, "theta"): 1 / 2,
    (2, "good"): 3 / 4,  # B. Nienhuis, Phys. Rev. Lett. 49, 1062 (1982)
    (3, "good"): 0.5876,  # N. Clisby, Phys. Rev. Lett. 104, 055702 (2010)
    (2, "ideal"): 1 / 2,
    (3, "ideal"): 1 / 2,
}


class ChainExponents(NamedTuple):
    """Exponents of n: `size` of R, `diffusion` of D, `relaxation` of the slowest time."""

    size: float
    diffusion: float
    relaxation: float


def chain_exponents(dynamics: str, solvent: str = "ideal", dimension: int = 3) -> ChainExponents:
    """Exponents of a long chain's size n^nu, diffusion coefficient and relaxation time.

    Without hydrodynamic interaction ("rouse") D goes as n^-1 and the time, R^2/D, as n^(1 + 2 nu);
    with it ("zimm") as n^-nu and n^(3 nu).

    Parameters: `dynamics` "rouse" or "zimm"; `solvent` "ideal" (beads pass through each other),
    "theta" or "good"; `dimension` 2 or 3, for zimm 3 only (in 2D diffusion depends on the box).
    Raises ValueError for others. Source: P.-G. de Gennes, Scaling Concepts in Polymer Physics
    (1979); nu as in `FLORY`. Valid for long chains: between 10 and 60 beads of hydrodynamic radius
    b/10 Zimm chains have -0.62 and 1.71 (`kirkwood_diffusion`, `zimm_times`).

    >>> chain_exponents("rouse")
    ChainExponents(size=0.5, diffusion=-1.0, relaxation=2.0)
    >>> [round(x, 4) for x in chain_exponents("zimm", "good")]
    [0.5876, -0.5876, 1.7628]
    """
    one_of(("rouse", "zimm"), dynamics=dynamics)
    one_of(("ideal", "theta", "good"), solvent=solvent)
    one_of((2, 3) if dynamics == "rouse" else (3,), dimension=dimension)
    nu = FLORY[dimension, solvent]
    if dynamics == "rouse":
        return ChainExponents(nu, -1.0, 1 + 2 * nu)
    return ChainExponents(nu, -nu, 3 * nu)
