"""Rotations and rigid rotation of the particles of a cell, in 3D."""

import math

from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import unit_open
from mesokit.scalar.vector import added_scaled, dot, scaled

ONE_PLACE = 1e-8  # of the mass: particles within 1e-4 cells of one another are in one place
SPREAD = 1e-3  # the same within 3e-2 cells
SLENDER = 1e-3  # det / trace^3 that is safely above LINE
LINE = 1e-7  # det / trace^3 of an inertia tensor below which the particles lie on a line


@scalar
def random_axis(a, b):
    """A unit vector, uniform on the sphere, from two random words."""
    s, co = sincos_turn(unit_open(a))
    z = 2.0 * unit_open(b) - 1.0
    radius = math.sqrt(max(1.0 - z * z, 0.0))
    return radius * co, radius * s, z


@scalar
def rotate(w, n, cos, sin):
    """Rotate the vector w about the unit vector n (Rodrigues)."""
    return turn(w, n, cos, sin, 1.0 - cos)


@scalar
def turn(w, n, cos, sin, along):
    """cos * w + sin * (n x w) + along * (n . w) n."""
    turned = added_scaled(scaled(cos, w), sin, cross(n, w))
    return added_scaled(turned, along * dot(n, w), n)


@scalar
def cross(a, b):
    """Vector product."""
    return (
        mul_add(a[1], b[2], -(a[2] * b[1])),
        mul_add(a[2], b[0], -(a[0] * b[2])),
        mul_add(a[0], b[1], -(a[1] * b[0])),
    )


@scalar
def angular_velocity(n, mass, q, angular_momentum):
    """Solve I omega = L for the inertia tensor I = tr(q) 1 - q, with q = sum m r r as
    (xx, yy, zz, xy, xz, yz), of n particles of this total mass.

    Two particles (or a line of them) have no inertia about their own axis, and no angular momentum
    either: the pseudo-inverse is then 2 / tr(I). Particles in one place do not rotate: what the
    rounded sums give there is noise.
    """
    lx, ly, lz = angular_momentum
    a, b, c = q[1] + q[2], q[0] + q[2], q[0] + q[1]
    d, e, f = -q[3], -q[4], -q[5]
    m00, m01, m02 = b * c - f * f, e * f - d * c, d * f - e * b
    m11, m12, m22 = a * c - e * e, d * e - a * f, a * b - d * d
    det = a * m00 + d * m01 + e * m02
    trace = a + b + c
    apart = n > 1.5 and trace > ONE_PLACE * mass
    regular = n > 2.5 and trace > 1e4 * ONE_PLACE * mass and det > LINE * trace * trace * trace
    inverse = 1.0 / (det if regular else 1.0)
    line = 2.0 / trace if apart else 0.0
    x = inverse * (m00 * lx + m01 * ly + m02 * lz)
    y = inverse * (m01 * lx + m11 * ly + m12 * lz)
    z = inverse * (m02 * lx + m12 * ly + m22 * lz)
    return (x if regular else line * lx, y if regular else line * ly, z if regular else line * lz)


@scalar
def spread_out(n, mass, q):
    """True if rounded sums resolve how these particles rotate, as the energy of it needs.

    Not if all lie within some hundredths of a cell, or three and more almost on a line.
    """
    a, b, c = q[1] + q[2], q[0] + q[2], q[0] + q[1]
    d, e, f = -q[3], -q[4], -q[5]
    det = a * (b * c - f * f) + d * (e * f - d * c) + e * (d * f - e * b)
    trace = a + b + c
    return trace > SPREAD * mass and (n < 2.5 or det > SLENDER * trace * trace * trace)


@scalar
def angular_speed(n, mass, inertia, angular_momentum):
    """The same in 2D."""
    apart = n > 1.5 and inertia > ONE_PLACE * mass
    return angular_momentum / inertia if apart else 0.0


@scalar
def second_moment(r):
    """The products (xx, yy, zz, xy, xz, yz) of a position."""
    return r[0] * r[0], r[1] * r[1], r[2] * r[2], r[0] * r[1], r[0] * r[2], r[1] * r[2]


@scalar
def central(moment, mass, r):
    """Second moments about the centre of mass r, from those about the origin."""
    own = second_moment(r)
    return (
        moment[0] - mass * own[0],
        moment[1] - mass * own[1],
        moment[2] - mass * own[2],
        moment[3] - mass * own[3],
        moment[4] - mass * own[4],
        moment[5] - mass * own[5],
    )
