"""Small symmetric matrices of a body, in scratch memory: the reflection and the noise of its gas.

Velocity and angular velocity of a body are one vector U of D = 3 numbers in 2D and 6 in 3D. Arms
are counted in levers (see `MovingBodies`), so that all numbers have one scale. Matrices are D x D.
"""

import math

from mesokit.method.mpcd.engine.bodies.state import (
    END_TURN,
    FOUR,
    HINGE,
    HINGED,
    INERTIA,
    IS_SLIP,
    ROOT,
    ROOT_INERTIA,
    THREE,
    load,
    of_kind,
    turn_by,
)
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar, seldom

# Places in scratch memory.
G, S, A, E, P, X = 0, 36, 72, 108, 144, 152
SWEEPS = 12  # of Jacobi's method: six are enough for all but rounding
SMALL = 1e-30


@scalar
def spread_sums(bodies, i, t, d, scales, work):
    """G = sum m B^T B and P = sum m B^T g of body i as floats, from the whole numbers t.

    B s = [1, -[s]] gives the velocity of a place at an arm s. scales: whole numbers per unit of
    mass and of momentum.
    """
    by_mass, by_momentum = 1.0 / scales[0], 1.0 / scales[1]
    size, first = d + 1 if d == 2 else 6, 0
    for k in range(36):
        work[G + k] = 0.0
    if of_kind(bodies, i, IS_SLIP) > 0.5:
        for a in range(size):
            for b in range(a, size):
                work[G + size * a + b] = work[G + size * b + a] = by_mass * float(t[first])
                first += 1
    elif d == 2:
        m, x, y, square = float(t[0]), float(t[1]), float(t[2]), float(t[3])
        work[G], work[G + 4], work[G + 8] = by_mass * m, by_mass * m, by_mass * square
        work[G + 2] = work[G + 6] = -by_mass * y
        work[G + 5] = work[G + 7] = by_mass * x
        first = 4
    else:
        m, x, y, z = float(t[0]), float(t[1]), float(t[2]), float(t[3])
        xx, yy, zz = float(t[4]), float(t[5]), float(t[6])
        for a in range(3):
            work[G + 7 * a] = by_mass * m
        # The upper right block is -m [s], the lower right one m (s s 1 - s s^T).
        work[G + 4], work[G + 5] = by_mass * z, -by_mass * y
        work[G + 9], work[G + 11] = -by_mass * z, by_mass * x
        work[G + 15], work[G + 16] = by_mass * y, -by_mass * x
        work[G + 21], work[G + 28], work[G + 35] = (
            by_mass * (yy + zz),
            by_mass * (xx + zz),
            by_mass * (xx + yy),
        )
        work[G + 22] = -by_mass * float(t[7])
        work[G + 23] = -by_mass * float(t[8])
        work[G + 29] = -by_mass * float(t[9])
        for a in range(6):
            for b in range(a):
                work[G + 6 * a + b] = work[G + 6 * b + a]
        first = 10
    for a in range(size):
        work[P + a] = by_momentum * float(t[first + a])


@scalar
def root_of_mobility(bodies, i, d, work):
    """S, the square root of one over mass and inertia of body i; 0 along what is fixed."""
    size = d + 1 if d == 2 else 6
    for k in range(size * size):
        work[S + k] = 0.0
    kind, lever = bodies.kind[i], bodies.lever
    for a in range(d):
        work[S + (size + 1) * a] = bodies.kinds[kind, ROOT + a]
    q = load(bodies.rows, i, END_TURN, FOUR)
    if bodies.kinds[kind, HINGED] > 0.5:
        h = load(bodies.kinds, kind, HINGE, THREE)
        about = turn_by(bodies, i, q, INERTIA, h)
        root = lever / math.sqrt(h[0] * about[0] + h[1] * about[1] + h[2] * about[2])
        for a in range(3):
            for b in range(3):
                put_rotation(work, d, a, b, root * h[a] * h[b])
    else:
        for b in range(3):
            column = turn_by(bodies, i, q, ROOT_INERTIA, with_item(THREE, b, 1.0))
            for a in range(3):
                put_rotation(work, d, a, b, lever * column[a])


@scalar
def put_rotation(work, d, a, b, x):
    """An element of the part of S that is about axes a and b; in 2D there is z alone."""
    if d == 3:
        work[S + 6 * (3 + a) + 3 + b] = x
    elif a == 2 and b == 2:
        work[S + 8] = x


@scalar
def sandwiched(size, work):
    """A = S G S, and S P in place of P."""
    for a in range(size):
        for b in range(size):
            total = 0.0
            for k in range(size):
                total += work[S + size * a + k] * work[G + size * k + b]
            work[E + size * a + b] = total
    for a in range(size):
        for b in range(size):
            total = 0.0
            for k in range(size):
                total += work[E + size * a + k] * work[S + size * k + b]
            work[A + size * a + b] = total
    for a in range(size):
        total = 0.0
        for k in range(size):
            total += work[S + size * a + k] * work[P + k]
        work[X + a] = total
    for a in range(size):
        work[P + a] = work[X + a]


@scalar
def times_root(size, work, factor):
    """X = factor S X."""
    for a in range(size):
        total = 0.0
        for k in range(size):
            total += work[S + size * a + k] * work[X + k]
        work[P + a] = factor * total
    for a in range(size):
        work[X + a] = work[P + a]


@seldom
def solve_reflection(bodies, i, t, d, scales, work):
    """X = 2 (1 + M^-1 G)^-1 M^-1 P: the change of U of body i by all hits as one reflection.

    It conserves energy and momentum of body and particles whatever the number of hits.
    """
    size = d + 1 if d == 2 else 6
    spread_sums(bodies, i, t, d, scales, work)
    root_of_mobility(bodies, i, d, work)
    sandwiched(size, work)
    # 1 + A is symmetric and positive: Cholesky's L L^T, in the lower half of A.
    for a in range(size):
        for b in range(a + 1):
            total = work[A + size * a + b] + (1.0 if a == b else 0.0)
            for k in range(b):
                total -= work[A + size * a + k] * work[A + size * b + k]
            if a == b:
                work[A + size * a + a] = math.sqrt(total)
            else:
                work[A + size * a + b] = total / work[A + size * b + b]
    for a in range(size):
        total = work[P + a]
        for k in range(a):
            total -= work[A + size * a + k] * work[X + k]
        work[X + a] = total / work[A + size * a + a]
    for c in range(size):
        a = size - 1 - c
        total = work[X + a]
        for k in range(a + 1, size):
            total -= work[A + size * k + a] * work[X + k]
        work[X + a] = total / work[A + size * a + a]
    times_root(size, work, 2.0)


@seldom
def solve_noise(bodies, i, t, d, scales, work):
    """X = [1 + (1 - M^-1 G)^(1/2)]^-1 M^-1 P: what of the noise of the gas in body i the motion of
    the body has already, if P is the thermal momentum of the gas.

    Eigenvalues of M^-1/2 G M^-1/2 above 1 are of a body lighter than its gas: 1/eigenvalue then.
    """
    size = d + 1 if d == 2 else 6
    spread_sums(bodies, i, t, d, scales, work)
    root_of_mobility(bodies, i, d, work)
    sandwiched(size, work)
    for a in range(size):
        for b in range(size):
            work[E + size * a + b] = 1.0 if a == b else 0.0
    # Jacobi's method: turn pairs of axes until A is diagonal. Columns of E are eigenvectors then.
    for _ in range(SWEEPS):
        rest = 0.0
        for a in range(size):
            for b in range(a):
                rest += abs(work[A + size * a + b])
        if rest < SMALL:
            break
        for a in range(size - 1):
            for b in range(a + 1, size):
                turn_pair(size, a, b, work)
    for a in range(size):
        work[X + a] = 0.0
    for c in range(size):
        along, eigenvalue = 0.0, work[A + size * c + c]
        for a in range(size):
            along += work[E + size * a + c] * work[P + a]
        if eigenvalue > 1.0:
            along /= eigenvalue
        else:
            along /= 1.0 + math.sqrt(1.0 - eigenvalue)
        for a in range(size):
            work[X + a] += along * work[E + size * a + c]
    times_root(size, work, 1.0)


@scalar
def turn_pair(size, a, b, work):
    """One rotation of Jacobi's method: element a b becomes 0."""
    off = work[A + size * a + b]
    if off == 0.0:
        return
    ratio = 0.5 * (work[A + size * b + b] - work[A + size * a + a]) / off
    t = 1.0 / (abs(ratio) + math.sqrt(ratio * ratio + 1.0))
    t = t if ratio >= 0.0 else -t
    c = 1.0 / math.sqrt(t * t + 1.0)
    s = t * c
    for k in range(size):
        x, y = work[A + size * k + a], work[A + size * k + b]
        work[A + size * k + a], work[A + size * k + b] = c * x - s * y, s * x + c * y
    for k in range(size):
        x, y = work[A + size * a + k], work[A + size * b + k]
        work[A + size * a + k], work[A + size * b + k] = c * x - s * y, s * x + c * y
    for k in range(size):
        x, y = work[E + size * k + a], work[E + size * k + b]
        work[E + size * k + a], work[E + size * k + b] = c * x - s * y, s * x + c * y


@scalar
def unlevered(bodies, d, work):
    """The solution as changes of velocity and angular velocity, three numbers each."""
    if d == 2:
        return (work[X], work[X + 1], 0.0), (0.0, 0.0, work[X + 2] / bodies.lever)
    return (work[X], work[X + 1], work[X + 2]), (
        work[X + 3] / bodies.lever,
        work[X + 4] / bodies.lever,
        work[X + 5] / bodies.lever,
    )
