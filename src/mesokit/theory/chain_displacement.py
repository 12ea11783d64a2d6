"""Mean square displacement of the beads of a molecule that drag nothing along."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory.mean_square_displacement import msd_molecular_chaos


def msd_rouse_beads(
    steps: ArrayLike,
    timestep: float,
    decorrelation: float,
    eigenvalues: ArrayLike,
    k: float,
    dimension: int,
    kT: float = 1.0,
    mass: float = 1.0,
) -> NDArray[np.float64]:
    """Mean square displacement after n steps, averaged over the beads of a Rouse molecule.

    That of the centre of mass, which is a particle as heavy as all beads, and of each normal mode p
    twice its mean square d kT/(k lambda_p), less the part that is left:
    (2/N) sum_p d kT/(k lambda_p) (1 - C_p(n)), C_p(n) = [M^n]_xx, where M turns (x, v) as the
    spring does in a timestep and then takes the share g off v. With more friction than inertia C_p
    is exp(-t/tau_p), and this is Rouse's sum.

    Parameters:
        steps: n >= 0, whole, any shape.
        timestep, decorrelation, dimension, kT, mass: as in `msd_molecular_chaos`, of a bead.
        eigenvalues: (N,) of the normal modes, the first 0, as `linear_modes` gives them.
        k: force constant of the springs, U = (k/2) r^2.

    Raises ValueError for a value out of range. Source: P. E. Rouse, J. Chem. Phys. 21, 1272 (1953);
    with inertia and steps derived here: the collisions of a mode are independent of one another.
    Valid for harmonic bonds and a mean free path of a cell or more; below, beads drag one another
    along and move farther.

    >>> msd_rouse_beads([0, 1, 10], 1.0, 0.5, [0, 2], 1.0, 3).round(4).tolist()
    [0.0, 2.7661, 40.499]
    """
    positive(k=k)
    n = np.asarray(steps)
    if np.any(n != n.astype(int)):
        raise ValueError(f"steps = {steps!r}: expected whole numbers")
    modes = np.asarray(eigenvalues, float)
    beads, modes = len(modes), modes[1:]
    centre = msd_molecular_chaos(n, timestep, decorrelation, dimension, kT, beads * mass)
    omega = np.sqrt(k * modes / mass)
    c, s = np.cos(omega * timestep), np.sin(omega * timestep)
    kept = 1.0 - decorrelation
    turn = np.array([[c, s / omega], [-kept * omega * s, kept * c]]).transpose(2, 0, 1)
    lags, where = np.unique(n.astype(int), return_inverse=True)
    now = np.broadcast_to(np.eye(2), turn.shape)
    inner = np.zeros(len(lags))
    for i, step in enumerate(np.diff(lags, prepend=0)):
        now = now @ np.linalg.matrix_power(turn, int(step))
        inner[i] = (2.0 / beads * dimension * kT / (k * modes) * (1.0 - now[:, 0, 0])).sum()
    return np.asarray(centre + inner[where].reshape(n.shape))
