"""Flow between two plates at rest, driven by a uniform acceleration that oscillates."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive


def oscillating_slit_response(
    y: ArrayLike, height: float, viscosity: float, frequency: float
) -> NDArray[np.complex128]:
    """Complex velocity chi(y) per acceleration: g cos(w t) drives Re(g chi exp(i w t)).

    Parameters: `y` any shape, distance from the lower plate, in [0, height]; `height` H of the slit
    in cells; `viscosity` nu, kinematic; `frequency` w, angular. Raises ValueError unless the last
    three are above 0. Source: derived here from du/dt = g cos(w t) + nu u'', no slip, after the
    start has been forgotten (in a time of H^2/(pi^2 nu)): chi = (1 - cosh(q z)/cosh(q H/2))/(i w)
    with z = y - H/2, q = sqrt(i w/nu); that of a pipe is J. R. Womersley, J. Physiol. 127, 553
    (1955). Slow: y (H - y)/(2 nu), Poiseuille. Fast: 1/(i w), a plug that lags by a quarter of a
    period between layers of thickness sqrt(2 nu/w). Valid while w is slow against the collisions,
    and the flow slow against sound.

    >>> slow = oscillating_slit_response([0, 5, 10], 10, 0.5, frequency=1e-6)
    >>> slow.real.round(6).tolist()
    [0.0, 25.0, 0.0]
    >>> fast = oscillating_slit_response(5, 10, 0.5, frequency=50.0)
    >>> round(float(abs(fast) * 50), 6), round(float(np.angle(fast, deg=True)), 6)
    (1.0, -90.0)
    """
    positive(height=height, viscosity=viscosity, frequency=frequency)
    q = np.sqrt(1j * frequency / viscosity)
    near = np.asarray(y, dtype=float)
    decays = np.exp(-q * near) + np.exp(-q * (height - near))  # cosh of large numbers overflows
    chi: Any = (1 - decays / (1 + np.exp(-q * height))) / (1j * frequency)
    return np.asarray(chi)


def oscillating_slit_velocity(
    y: ArrayLike,
    time: ArrayLike,
    height: float,
    acceleration: float,
    viscosity: float,
    frequency: float,
) -> NDArray[np.float64]:
    """Velocity at a time t, driven by g cos(w t), long after the start.

    Parameters as in `oscillating_slit_response`; `time` of any shape that goes with that of `y`;
    `acceleration` g. Raises ValueError, source and range: as there.

    >>> u = oscillating_slit_velocity(5, [0.0, 10.0], 10, 0.01, 0.5, frequency=2 * np.pi / 40)
    >>> u.round(5).tolist()
    [0.0162, 0.07099]
    """
    chi = oscillating_slit_response(y, height, viscosity, frequency)
    phase = np.exp(1j * frequency * np.asarray(time, dtype=float))
    return np.asarray((acceleration * chi * phase).real)
