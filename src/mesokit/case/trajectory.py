"""Which particles of a case are written, and how often."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.case.sites import SiteLattice

Quantity = Literal["position", "velocity", "spin", "orientation", "image", "site", "id", "contact"]
WIDTHS = {"image": 4, "site": 2, "id": 8}  # bytes of a field; the others follow the precision
COMPRESSED = 0.9  # thermal noise hardly compresses
PAIR = 16  # bytes of the two numbers of a contact


class Kind(NamedTuple):
    """Equal particles: mass of each, how many there are, and what files for others call them.

    `diameter` is that of a particle in pictures, in cells. `shape` is what files for others call
    one that is no sphere, with its own axes: an entry of `particles/type_shapes` of GSD. `inertia`
    (3,) are moments about these axes, where they are principal ones of a rigid body.
    """

    mass: float
    number: int
    name: str = ""
    diameter: float = 0.5
    shape: Mapping[str, Any] | None = None
    inertia: tuple[float, float, float] | None = None


SUSPENDED = "suspended"  # all groups but the first


class Group(NamedTuple):
    """Particles with consecutive numbers, such as a fluid or its solutes, kind after kind.

    `has` are quantities of each in an engine: those that trajectories may hold, of which an
    "orientation" is a unit quaternion (w, x, y, z); "mass" and "diameter" where each has its own;
    "heading" where pictures show the direction of a velocity at one time. "contact": forces and
    places of all contacts, of those particles that have lasting ones. Sites of a lattice are a
    group that has "site", the number of the state of each: `lattice` is where they are, and
    `states` are the names of the states, none of heights. `kT` is the thermal energy of velocities;
    `picture` the kind of pictures that shows it unless another is chosen.
    """

    name: str
    kinds: tuple[Kind, ...]
    has: tuple[str, ...] = ("position", "velocity", "image", "id")
    kT: float = 0.0
    picture: str = ""
    lattice: SiteLattice | None = None
    states: tuple[str, ...] = ()

    @property
    def number(self) -> int:
        """How many particles."""
        return sum(kind.number for kind in self.kinds)

    @property
    def noun(self) -> str:
        """What one of them is called in messages."""
        return "particle" if self.lattice is None else "site"


@component
class Trajectory:
    """Particles written to the H5MD file of the run."""

    every: int = param(doc="steps between two frames", ge=1)
    per_decade: int | None = param(
        None,
        doc="frames in each decade of time, of those every so many steps (all unless said)",
        ge=1,
        le=1000,
    )
    of: str = param(
        "all",
        doc='whose particles: "all", or, of MPCD, "fluid", "solutes", "bodies" or, both of these, '
        '"suspended"',
    )
    fields: Many[Quantity] = param(("position",), doc="what is written", min_length=1)
    subset: int | None = param(
        None, doc="only the first particles, so many (all unless said)", ge=1
    )
    precision: Literal["float32", "float64"] = param("float32", doc="of the stored numbers")
    compression: int = param(4, doc="gzip level: 0 none, 9 smallest", ge=0, le=9)

    def due(self, passed: int) -> bool:
        """True if a frame is due so many steps after the warm-up."""
        if passed < 0 or passed % self.every:
            return False
        return self.next_after(passed - 1) == passed

    def next_after(self, passed: int) -> int:
        """The steps after the warm-up of the next frame, more than `passed`.

        >>> spread = Trajectory(every=10, per_decade=3)
        >>> [spread.next_after(passed) for passed in (-1, 0, 10, 90)]
        [0, 10, 30, 100]
        """
        if passed < 0:
            return 0
        number = passed // self.every + 1  # of frames if all were due
        if self.per_decade is not None:
            number = _next_of_decade(number, self.per_decade)
        return number * self.every

    def frames(self, steps: int) -> Sequence[int]:
        """Steps after the warm-up of all frames of a run of so many.

        >>> Trajectory(every=1, per_decade=4).frames(40), Trajectory(every=5).frames(12)
        ([0, 1, 2, 4, 6, 10, 18, 32], range(0, 13, 5))
        """
        if self.per_decade is None:
            return range(0, steps + 1, self.every)
        found, passed = [], self.next_after(-1)
        while passed <= steps:
            found.append(passed)
            passed = self.next_after(passed)
        return found


def _next_of_decade(number: int, per_decade: int) -> int:
    """The least of the rounded up powers 10^(m/per_decade) that is not below a number."""
    m = max(0, math.floor(per_decade * math.log10(number)) - 1)
    while (found := math.ceil(10 ** (m / per_decade) * (1 - 1e-12))) < number:
        m += 1
    return found


def written(trajectory: Trajectory, groups: Sequence[Group]) -> tuple[int, int]:
    """How many particles the trajectory may hold, and the number of the first.

    >>> fluid, solutes = Group("fluid", (Kind(1.0, 90),)), Group("solutes", (Kind(5.0, 10),))
    >>> written(Trajectory(every=1, of="solutes"), [fluid, solutes])
    (10, 90)
    """
    if trajectory.of == SUSPENDED:
        return sum(group.number for group in groups[1:]), groups[0].number
    first = 0
    for group in groups:
        if group.name == trajectory.of:
            return group.number, first
        first += group.number
    return first, 0


def masses_and_kinds(groups: Sequence[Group]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The mass of each kind of particles, and the kind of each particle, by number.

    >>> masses_and_kinds([Group("fluid", (Kind(1.0, 3),)), Group("solutes", (Kind(5.0, 2),))])
    (array([1., 5.]), array([0, 0, 0, 1, 1]))
    """
    kinds = [kind for group in groups for kind in group.kinds]
    return (
        np.array([kind.mass for kind in kinds], float),
        np.repeat(np.arange(len(kinds)), [kind.number for kind in kinds]),
    )


def kinds_of(groups: Sequence[Group], ids: NDArray[np.int64]) -> NDArray[np.int64]:
    """The kind of some particles.

    >>> groups = [Group("fluid", (Kind(1.0, 3),)), Group("solutes", (Kind(5.0, 2),))]
    >>> kinds_of(groups, np.array([2, 3]))
    array([0, 1])
    """
    numbers = [kind.number for group in groups for kind in group.kinds]
    return np.searchsorted(np.cumsum(numbers), ids, side="right")


def names_and_diameters(groups: Sequence[Group]) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    """Name of each kind of particles for other programs, and the diameter in which it is drawn.

    Names are never single letters, which stand for chemical elements.

    >>> beads = Group("solutes", (Kind(5.0, 2, "polymer-1", diameter=1.0),))
    >>> names_and_diameters([Group("fluid", (Kind(1.0, 3),)), beads])
    (('fluid', 'polymer-1'), array([0.5, 1. ]))
    >>> names_and_diameters([Group("fluid", (Kind(1.0, 3), Kind(2.0, 3)))])[0]
    ('fluid-1', 'fluid-2')
    """
    names = [
        kind.name or (f"{group.name}-{i}" if len(group.kinds) > 1 else group.name)
        for group in groups
        for i, kind in enumerate(group.kinds, start=1)
    ]
    return tuple(names), np.array([kind.diameter for group in groups for kind in group.kinds])


def components(field: str, dimension: int) -> int:
    """Number of components of a field of each particle: disks spin about one axis, spheres about 3,
    an orientation is a unit quaternion. A contact has three vectors and a gap; a sphere of an
    isostatic packing has as many, shared by two, as the box has axes.

    >>> [components(field, 2) for field in ("position", "spin", "id")], components("spin", 3)
    ([2, 1, 1], 3)
    """
    fixed = {"spin": 1 if dimension == 2 else 3, "orientation": 4, "id": 1, "site": 1}
    fixed["contact"] = dimension * (3 * dimension + 1)
    return fixed.get(field, dimension)


def stored_bytes(
    trajectory: Trajectory | None, groups: Sequence[Group], dimension: int, steps: int
) -> int:
    """Estimated bytes of the file of a trajectory after so many steps."""
    if trajectory is None:
        return 0
    number = 4 if trajectory.precision == "float32" else 8
    per_particle = sum(
        WIDTHS.get(name, number) * components(name, dimension) for name in trajectory.fields
    )
    per_particle += PAIR * dimension * ("contact" in trajectory.fields)
    particles, _ = written(trajectory, groups)
    frames = len(trajectory.frames(steps))
    shrink = COMPRESSED if trajectory.compression else 1.0
    return round(frames * min(trajectory.subset or particles, particles) * per_particle * shrink)
