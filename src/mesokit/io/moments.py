"""Particles and frames of them, as files for other programs contain."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class Particles(NamedTuple):
    """Constant properties of particles: (n,) numbers from 0, kinds from 0, and masses.

    `names` of the kinds; `diameter` (n,); `molecule` (n,) from 0, -1 for single particles; `bonds`
    (b, 2) of rows; `size` (3,) of the box, one cell deep in 2D; `closed` axes. `spheres`: whether
    particles are of these diameters, and not only drawn so. `shapes`: those of kinds that are no
    spheres, by the number of the kind, as GSD has them; `inertia` (3,): moments about their axes.
    """

    number: NDArray[np.int64]
    kind: NDArray[np.int64]
    mass: Array
    names: tuple[str, ...]
    diameter: Array
    molecule: NDArray[np.int64]
    bonds: NDArray[np.int64]
    dimension: int
    size: Array
    closed: tuple[bool, bool, bool]
    spheres: bool = False
    shapes: Mapping[int, Mapping[str, Any]] = MappingProxyType({})
    inertia: Mapping[int, tuple[float, float, float]] = MappingProxyType({})


class Moment(NamedTuple):
    """One frame in three dimensions, z = 0 in 2D.

    `position` (n, 3) in the cell spanned by (L_x, 0, 0), (tilt, L_y, 0) and (0, 0, L_z) from the
    origin on; `velocity`, `spin` (angular velocity) and `image` (n, 3), counts of these edges, or
    None; `orientation` (n, 4), unit quaternions w, x, y, z, or None.
    """

    step: int
    time: float
    tilt: float
    position: Array
    velocity: Array | None
    image: Array | None
    spin: Array | None = None
    orientation: Array | None = None
