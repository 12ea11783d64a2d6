"""What contacts remember, in memory: rows of no, three or six numbers."""

from mesokit.method.soft_spheres.machine.lists import ROLLING, SLIDING
from mesokit.method.soft_spheres.machine.spring import Springs
from mesokit.scalar.jit import scalar


@scalar
def kept(springs, i, s):
    """The springs of a contact; not stretched where contacts remember nothing."""
    sliding, rolling = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if springs.shape[2] > SLIDING:
        sliding = springs[i, s, 0], springs[i, s, 1], springs[i, s, 2]
    if springs.shape[2] > ROLLING:
        rolling = springs[i, s, 3], springs[i, s, 4], springs[i, s, 5]
    return Springs(sliding, rolling)


@scalar
def keep(springs, i, s, now):
    """Remember the springs of a contact."""
    if springs.shape[2] > SLIDING:
        springs[i, s, 0], springs[i, s, 1], springs[i, s, 2] = now.sliding
    if springs.shape[2] > ROLLING:
        springs[i, s, 3], springs[i, s, 4], springs[i, s, 5] = now.rolling


@scalar
def forget(springs, i, s, still):
    """Forget a contact, unless it is still there (1.0 or 0.0)."""
    if springs.shape[2] > SLIDING:
        springs[i, s, 0] *= still
        springs[i, s, 1] *= still
        springs[i, s, 2] *= still
    if springs.shape[2] > ROLLING:
        springs[i, s, 3] *= still
        springs[i, s, 4] *= still
        springs[i, s, 5] *= still
