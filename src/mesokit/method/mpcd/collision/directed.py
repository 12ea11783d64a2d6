"""Random rotations that turn a vector towards another, with Boltzmann's weight of the angle.

What is turned is a, towards b: the probability of a direction is exp(strength a . b), a being the
vector after the rotation. In the plane that is von Mises' distribution (drawn as Best and Fisher
do, Appl. Statist. 28, 152 (1979)), in space that of von Mises and Fisher.
"""

import math

import numpy as np

from mesokit.method.mpcd.collision.rotation import cross
from mesokit.scalar.elementary import log, short_exp, sincos_turn
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import philox, unit_open
from mesokit.scalar.vector import added, dot, scaled

FAINT = 1e-6  # strength times both lengths that no draw can tell from none
MOST_DRAWS = 200  # each is accepted with more than 65 %
NO_KEY = np.uint64(0)  # the words of the cell are the counter, and no two cells share them
MORE = np.uint64(1)


@scalar
def unit_vector(a, otherwise):
    """The direction of a vector, and its length; `otherwise` for none."""
    length = math.sqrt(dot(a, a))
    if length > 0.0:
        return scaled(1.0 / length, a), length
    return otherwise, 0.0


@scalar
def direction(chance, strength, a, b):
    """A random unit vector in the plane: where a points after its rotation."""
    along, longer = unit_vector(b, (1.0, 0.0))
    _, length = unit_vector(a, (1.0, 0.0))
    k = strength * length * longer
    sin, cos = von_mises(chance, k)
    return cos * along[0] - sin * along[1], sin * along[0] + cos * along[1]


@scalar
def von_mises(chance, k):
    """Sine and cosine of an angle whose probability is exp(k cos)."""
    sin, cos = sincos_turn(unit_open(chance[0]))
    if k < FAINT:
        return sin, cos
    root = math.sqrt(1.0 + 4.0 * k * k)
    # (1 + rho^2) / (2 rho) of Best and Fisher, without their differences of like numbers
    tau = 1.0 + root
    ratio = (tau + math.sqrt(2.0 * tau)) / (2.0 * k)  # 1 / rho, as tau^2 - 2 tau = 4 k^2
    r = 0.5 * (ratio + 1.0 / ratio)
    x, attempt = unit_open(chance[1]), 1
    while attempt < MOST_DRAWS:
        f = (1.0 + r * cos) / (r + cos)
        c = k * (r - f)
        if c * (2.0 - c) > x or log(c / x) + 1.0 - c >= 0.0:
            f = min(max(f, -1.0), 1.0)
            s = math.sqrt(1.0 - f * f)
            return (s if sin > 0.0 else -s), f
        p, q, _, _ = philox(chance[0], chance[1], np.uint64(attempt), MORE, NO_KEY, NO_KEY)
        sin, cos = sincos_turn(unit_open(p))
        x = unit_open(q)
        attempt += 1
    return 0.0, 1.0


@scalar
def perpendicular(n):
    """A unit vector at right angles to the unit vector n."""
    if abs(n[0]) < 0.7:
        side, _ = unit_vector((0.0, n[2], -n[1]), (0.0, 1.0, 0.0))
    else:
        side, _ = unit_vector((-n[2], 0.0, n[0]), (0.0, 1.0, 0.0))
    return side


@scalar
def quaternion(chance, strength, a, b):
    """A random rotation in space, as a quaternion: by all that turn a to the same direction alike.

    It is the half turn that brings a there, and then any turn about that direction.
    """
    start, length = unit_vector(a, (1.0, 0.0, 0.0))
    along, longer = unit_vector(b, (1.0, 0.0, 0.0))
    k = strength * length * longer
    u = unit_open(chance[0])
    cos = 2.0 * u - 1.0
    if k >= FAINT:
        cos = 1.0 + log(u + (1.0 - u) * short_exp(max(-2.0 * k, -600.0))) / k
        cos = min(max(cos, -1.0), 1.0)
    radius = math.sqrt(1.0 - cos * cos)
    s, c = sincos_turn(unit_open(chance[1]))
    one = perpendicular(along)
    other = cross(along, one)
    aim = added(scaled(cos, along), added(scaled(radius * c, one), scaled(radius * s, other)))
    half, _ = unit_vector(added(start, aim), perpendicular(start))
    spin, _, _, _ = philox(chance[0], chance[1], np.uint64(0), MORE, NO_KEY, NO_KEY)
    s, c = sincos_turn(0.5 * unit_open(spin))
    w = -s * dot(aim, half)
    return (w,) + added(scaled(c, half), scaled(s, cross(aim, half)))


@scalar
def turned_by(q, v):
    """A vector rotated by a unit quaternion (w, x, y, z)."""
    n = q[1], q[2], q[3]
    twice = scaled(2.0, cross(n, v))
    return added(added(v, scaled(q[0], twice)), cross(n, twice))
