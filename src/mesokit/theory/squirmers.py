"""Swimmers whose surface moves along itself: speed, flow and diffusion of squirmers.

A squirmer has the axis e and the surface velocity u(theta) along the meridian, with theta the angle
from e: B1 sin theta + B2 sin theta cos theta in 3D, B1 sin theta + B2 sin 2 theta in 2D. With
beta = B2/B1 it is a pusher for beta < 0, a puller for beta > 0.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, not_negative, positive
from mesokit.theory.ellipsoid_friction import depolarisation

Array = NDArray[np.float64]


def squirmer_speed(B1: float, dimension: int = 3, aspect: float = 1.0) -> float:
    """Swimming speed B1 (1 - N) in a fluid without bounds, N the depolarisation factor of the axis.

    2 B1/3 of a sphere and B1/2 of a disk; r B1/(1 + r) of an ellipse. The surface velocity of a
    spheroid or an ellipse is B1 (t.e) along its tangent t. B2 changes no speed, by symmetry.

    Parameters: `B1` in cells per unit of time; `dimension` 2 or 3; `aspect` r, the half axis along
    e over that across (below 1: oblate). Raises ValueError for a value out of range. Source: M. J.
    Lighthill, Commun. Pure Appl. Math. 5, 109 (1952); J. R. Blake, J. Fluid Mech. 46, 199 (1971);
    spheroids: S. R. Keller and T. Y. Wu, J. Fluid Mech. 80, 259 (1977), whose result
    tau (tau - (tau^2 - 1) arcoth tau), 1/tau the eccentricity, is the same; ellipses: derived here,
    minus the surface mean of (n.x) u. Valid without inertia.

    >>> [round(squirmer_speed(1.0, 3, r), 3) for r in (0.5, 1.0, 1.5, 2.0, 3.0)]
    [0.473, 0.667, 0.767, 0.826, 0.891]
    >>> squirmer_speed(1.0, 2)
    0.5
    """
    dimension_two_or_three(dimension)
    positive(aspect=aspect)
    if dimension == 2:
        return B1 * aspect / (1 + aspect)
    return B1 * (1 - depolarisation((aspect, 1.0, 1.0), 0))


def squirmer_speed_in_box(
    speed: float, fraction: float, slip: float = 0.0, collisional_share: float = 0.0
) -> float:
    """Speed U (1 - phi)/(1 + (2 - c) b/R) of a sphere or disk in a periodic cube or square.

    Its images, and the flow back in the box, take the share phi. A slip of length b on top of the
    surface velocity takes the rest; where the stress of the fluid is not symmetric it does less.

    Parameters: `speed` U without bounds; `fraction` phi, volume of the body over that of the box;
    `slip` b/R; `collisional_share` c of the viscosity that does not conserve angular momentum (0
    for rules +a). Raises ValueError for a value out of range. Source: derived in docs/theory.md, to
    first order in phi; exact for every B2. In the frame where the volume flux is zero.

    >>> round(squirmer_speed_in_box(0.02, 0.03), 5), squirmer_speed_in_box(0.02, 0.0, slip=0.5)
    (0.0194, 0.01)
    """
    not_negative(fraction=fraction, slip=slip, collisional_share=collisional_share)
    if max(fraction, collisional_share) > 1:
        raise ValueError("fraction, collisional_share: expected at most 1")
    return speed * (1 - fraction) / (1 + (2 - collisional_share) * slip)


def squirmer_speed_inertial(speed: float, beta: float, reynolds: float) -> float:
    """Speed U (1 - 0.15 beta Re) of a sphere at a small Reynolds number.

    Parameters: `speed` U without inertia; `beta` B2/B1; `reynolds` Re = U R/nu. Raises ValueError
    for Re below 0. Source: S. Wang and A. Ardekani, Phys. Fluids 24, 101902 (2012); A. S. Khair and
    N. G. Chisholm, Phys. Fluids 26, 011902 (2014). Valid to first order in Re, in 3D.

    >>> round(squirmer_speed_inertial(0.02, beta=-5, reynolds=0.1), 4)
    0.0215
    """
    not_negative(reynolds=reynolds)
    return speed * (1 - 0.15 * beta * reynolds)


def squirmer_flow(
    places: ArrayLike,
    axis: ArrayLike,
    radius: float,
    B1: float,
    B2: float,
    slip: float = 0.0,
    volume: float | None = None,
    collisional_share: float = 0.0,
) -> Array:
    """Velocity of the fluid about a squirming sphere or disk, in the frame of the fluid at rest.

    With e.r = r cos theta: in 3D
        u_r = (2/3) B1 (R/r)^3 cos + B2 ((R/r)^4 - (R/r)^2) (3 cos^2 - 1)/2,
        u_theta = (1/3) B1 (R/r)^3 sin + B2 (R/r)^4 sin cos;
    in 2D
        u_r = (1/2) B1 (R/r)^2 cos + B2 ((R/r)^3 - R/r) cos 2 theta,
        u_theta = (1/2) B1 (R/r)^2 sin + B2 (R/r)^3 sin 2 theta.
    Inside it is the velocity of the body. A slip of length b divides B1 by 1 + (2 - c) b/R and B2
    by 1 + (d + 2 - c) b/R. The images in a periodic cube or square of volume V add a flow that is
        -phi U e + 4 pi B2 R^(d - 1) (e (e.r) - r/d)/((d + 2) V)
    to first order in phi, the volume of the body over V, as a mean over directions of e.

    Parameters: `places` (..., d) from the centre of the body, in cells; `axis` (d,) e, of any
    length; `radius` R; `B1`, `B2` in cells per unit of time; `slip` b/R; `volume` V (no images
    unless said); `collisional_share` c of the viscosity that does not conserve angular momentum (0
    for rules +a). Raises ValueError for shapes that do not fit and values out of range. Source: J.
    R. Blake, J. Fluid Mech. 46, 199 (1971); 2D, slip and images: derived here, in docs/theory.md.
    Valid without inertia; in a box where the volume flux is zero.

    >>> squirmer_flow([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [1, 0, 0], 1.0, B1=1.0, B2=0.0).round(4)
    array([[ 0.0833,  0.    ,  0.    ],
           [-0.0417,  0.    ,  0.    ]])
    """
    r, e = np.asarray(places, float), np.asarray(axis, float)
    if e.shape not in ((2,), (3,)) or r.shape[-1:] != e.shape:
        raise ValueError(f"axis of {e.shape}, places of {r.shape}: expected (d,) and (..., d)")
    positive(radius=radius, **({} if volume is None else {"volume": volume}))
    not_negative(slip=slip, collisional_share=collisional_share)
    e, d = e / np.linalg.norm(e), len(e)
    B1 = B1 / (1 + (2 - collisional_share) * slip)
    B2 = B2 / (1 + (d + 2 - collisional_share) * slip)
    distance = np.maximum(np.linalg.norm(r, axis=-1, keepdims=True), 1e-300)
    out = r / distance
    cosine = (out @ e)[..., None]
    toward = cosine * out - e  # sin theta times the unit vector of theta
    q = radius / np.maximum(distance, radius)
    speed = squirmer_speed(B1, d)
    if d == 3:
        dipole = speed * q**3 / 2
        stretch = B2 * (q**4 - q**2) * (3 * cosine**2 - 1) / 2
        whirl = B2 * q**4 * cosine
        along = 2 * dipole * cosine + stretch
    else:
        dipole = speed * q**2
        along = dipole * cosine + B2 * (q**3 - q) * (2 * cosine**2 - 1)
        whirl = 2 * B2 * q**3 * cosine
    flow = along * out + (dipole + whirl) * toward
    if volume is not None:
        back = (math.pi if d == 2 else 4 * math.pi / 3) * radius**d / volume * speed
        strain = 4 * math.pi * B2 * radius ** (d - 1) / ((d + 2) * volume)
        flow += strain * ((r @ e)[..., None] * e - r / d) - back * e
        speed -= back
    return np.asarray(np.where(distance < radius, speed * e, flow))


def swimmer_diffusion(
    diffusion: float, speed: float, rotational_diffusion: float, dimension: int
) -> float:
    """Diffusion coefficient D + U^2/(d (d - 1) D_r) of a swimmer at late times.

    Parameters: `diffusion` D of the body when it does not swim; `speed` U; `rotational_diffusion`
    D_r of its axis; `dimension` d, 2 or 3. Raises ValueError for a value out of range. Source: J.
    R. Howse et al., Phys. Rev. Lett. 99, 048102 (2007), from H. C. Berg, Random Walks in Biology
    (1983). Valid at times above 1/D_r.

    >>> round(swimmer_diffusion(0.01, 0.1, rotational_diffusion=0.05, dimension=3), 4)
    0.0433
    """
    dimension_two_or_three(dimension)
    not_negative(diffusion=diffusion)
    positive(rotational_diffusion=rotational_diffusion)
    return diffusion + speed**2 / (dimension * (dimension - 1) * rotational_diffusion)
