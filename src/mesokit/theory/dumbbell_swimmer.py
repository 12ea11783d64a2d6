"""Swimmers whose force acts on a ball and whose counter-force acts on the fluid beside it."""

import math

import numpy as np

from mesokit.theory._check import dimension_two_or_three, not_negative, positive
from mesokit.theory.drawn_body import disk_friction_in_square, sphere_friction_in_cube

WIDE = {2: 60.0, 3: 8.0}  # distances: a wider box acts as such a one, to a few thousandths


def dumbbell_speed(
    force: float,
    radius: float,
    distance: float,
    viscosity: float,
    box_length: float,
    dimension: int = 3,
    counter_radius: float = 1.0,
    slip: float = 0.0,
) -> float:
    """Speed of a sphere or disk under a force F, with -F on the fluid at a distance on its axis.

    F over the friction in the box, less what the counter-force does to it: F/(eta L^d) times the
    sum over all k = 2 pi n/L but zero of S(kR) B(ka) g(kd)/k^2. The mean over the surface is S =
    sin x/x, in 2D J0(x); over the ball of the counter-force B = 3 (sin x - x cos x)/x^3, in 2D 2
    J1(x)/x; over directions of the axis g = 2 (sin x - x cos x)/x^3, in 2D J1(x)/x. In 3D without a
    box it is F/(eta pi) (1/(6 R) - 1/(4 d) + R^2/(12 d^3) + a^2/(20 d^3)).

    Parameters: `force` F, in kT/a; `radius` R of the body; `distance` d of the middle of the ball
    in which the fluid takes -F; `viscosity` eta, dynamic; `box_length` L, in 3D also inf;
    `dimension` 2 or 3; `counter_radius` a of that ball; `slip` length b at the body, in the part of
    its own force alone. Raises ValueError for a value out of range and for a ball that overlaps the
    body.
    Source: H. Faxen, Ann. Phys. 68, 89 (1922), and derived in docs/theory.md. Valid for U d/nu well
    below 1 in 3D, and below 0.1 in 2D: inertia makes a pusher faster, a puller slower.

    >>> round(dumbbell_speed(20, radius=2, distance=5, viscosity=4, box_length=24), 4)
    0.0575
    >>> round(dumbbell_speed(8, radius=2, distance=5, viscosity=4, box_length=30, dimension=2), 4)
    0.0781
    """
    dimension_two_or_three(dimension)
    positive(radius=radius, distance=distance, viscosity=viscosity, counter_radius=counter_radius)
    not_negative(slip=slip)
    if distance < radius + counter_radius:
        raise ValueError(
            f"distance = {distance!r}: expected at least both radii, {radius + counter_radius:g}"
        )
    if dimension == 3 and math.isinf(box_length):
        own = (1 + slip / (radius + 2 * slip)) / (6 * radius)
        other = 1 / (4 * distance) - radius**2 / (12 * distance**3)
        other -= counter_radius**2 / (20 * distance**3)
        return force / (math.pi * viscosity) * (own - other)
    friction = sphere_friction_in_cube if dimension == 3 else disk_friction_in_square
    side = min(box_length, WIDE[dimension] * distance)
    own = 1 / friction(radius, side, viscosity, slip)
    most = math.ceil(2 * side / radius)  # terms fall as k to the power -7 in 3D, -5 in 2D
    number = np.ones(1)  # of vectors n, by their square, direction by direction
    for _ in range(dimension):
        before, number = number, np.zeros(len(number) + most**2)
        for n in range(most + 1):
            number[n * n : n * n + len(before)] += (1 if n == 0 else 2) * before
    size = np.flatnonzero(number)[1:]
    k, number = 2 * math.pi / side * np.sqrt(size), number[size]
    over, within, turned = _means(k * radius, k * counter_radius, k * distance, dimension)
    other = (number * over * within * turned / k**2).sum() / (viscosity * side**dimension)
    return float(force * (own - other))


def _means(
    surface: np.ndarray, ball: np.ndarray, apart: np.ndarray, dimension: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if dimension == 3:
        moment = [(np.sin(x) - x * np.cos(x)) / x**3 for x in (ball, apart)]
        return np.sinc(surface / math.pi), 3 * moment[0], 2 * moment[1]
    from scipy.special import j0, j1

    return j0(surface), 2 * j1(ball) / ball, j1(apart) / apart
