"""Springs of contacts in memory: rows of no, three or six numbers, one for each contact."""

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.method.spheres.soft.engine.contact.spring import Springs
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import scaled

SLIDING, ROLLING = 0, 3  # where the two springs of a contact are
NO_SPRINGS = Springs((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@scalar
def kept(springs, c):
    """The springs of contact c; not stretched where contacts remember nothing."""
    sliding, rolling = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if springs.shape[1] > SLIDING:
        sliding = springs[c, 0], springs[c, 1], springs[c, 2]
    if springs.shape[1] > ROLLING:
        rolling = springs[c, 3], springs[c, 4], springs[c, 5]
    return Springs(sliding, rolling)


@scalar
def keep(springs, c, now):
    """Remember the springs of a contact."""
    if springs.shape[1] > SLIDING:
        springs[c, 0], springs[c, 1], springs[c, 2] = now.sliding
    if springs.shape[1] > ROLLING:
        springs[c, 3], springs[c, 4], springs[c, 5] = now.rolling


@scalar
def kept_between(lists, i, j):
    """The springs of spheres i and j as i sees them: along the surface with the other sign if j
    keeps them, those of rolling as they are."""
    for s in range(lists.own[i]):
        if lists.near[i, s] == j:
            return kept(lists.springs, lists.begin[i] + s)
    for s in range(lists.own[j]):
        if lists.near[j, s] == i:
            found = kept(lists.springs, lists.begin[j] + s)
            return Springs(scaled(-1.0, found.sliding), found.rolling)
    return NO_SPRINGS


@kernel
def carry_springs(worker, order, old, new):
    """Bring what contacts remember from old lists to new ones; `order`: where a sphere was."""
    first, last = share(len(order), worker.thread, worker.threads)
    for i in range(first, last):
        for s in range(new.own[i]):
            found = kept_between(old, order[i], order[new.near[i, s]])
            keep(new.springs, new.begin[i] + s, found)
