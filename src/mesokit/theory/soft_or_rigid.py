"""Where soft spheres and rigid grains cost the same."""

from mesokit.theory._check import dimension_two_or_three, positive


def stiffness_of_equal_cost(
    grains: float, dimension: int, radius: float = 1.0, mass: float = 1.0, speed: float = 1.0
) -> float:
    """Stiffness K at which soft spheres and contact dynamics take as long: K r^2/(m v^2) = N^(4/d).

    Soft spheres take (r/v) sqrt(K/m) steps while a grain moves by its radius; forces take N^(2/d)
    sweeps to cross a packing of rigid grains. Above that stiffness contact dynamics is cheaper. A
    law of the power alone: the costs of a step and of a sweep are left out.

    Parameters: `grains` N; `dimension` 2 or 3; `radius` r, `mass` m, `speed` v of a grain. Raises
    ValueError for numbers out of range. Source: T. Unger, L. Brendel, D. E. Wolf and J. Kertesz,
    Phys. Rev. E 65, 061305 (2002).

    >>> stiffness_of_equal_cost(1000, 2), round(stiffness_of_equal_cost(1000, 3), 6)
    (1000000.0, 10000.0)
    """
    positive(grains=grains, radius=radius, mass=mass, speed=speed)
    dimension_two_or_three(dimension)
    return float(mass * (speed / radius) ** 2 * grains ** (4 / dimension))
