"""The keys of the section `[spheres]` that all methods of spheres share."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, ClassVar

from pydantic import field_validator, model_validator

from mesokit.case.amounts import count_text
from mesokit.case.box import Box
from mesokit.case.component import component, param, show
from mesokit.case.describe.hints import Many
from mesokit.case.warnings import require_memory
from mesokit.errors import CaseError
from mesokit.method.spheres.common.kinds import SphereKind, ball_volume, closest_packing
from mesokit.method.spheres.common.start import SphereStart
from mesokit.method.spheres.common.start.lattice import LatticeStart

if TYPE_CHECKING:
    from mesokit.method.spheres.hard.collision.protocol import SphereCollision
    from mesokit.method.spheres.hard.heating.protocol import Heating

KEYS = {"walls": "wall"}  # field -> key in the file, where they differ: one [[wall]] each
USUAL_FRACTION = 0.3  # of the box that spheres fill, unless anything is said
MOST_PARTICLES = 2**31 - 1  # numbers of random words are 32-bit
AMOUNTS = ("number", "density", "packing_fraction")
ONE = SphereKind(1.0)
STRONGEST = 1e9  # gravity beyond which it is a slip of the pen


@component
class Spheres:
    """Spheres: how many of which kinds, and where they start from.

    Their number follows from `number`, `density` or `packing_fraction`. Where the packing fraction
    is given beside one of the others, diameters are scaled so that both hold.
    """

    hard: ClassVar[bool] = True  # none may lie on another
    deforms: ClassVar[bool] = False  # overlaps are what forces follow from
    bytes_each: ClassVar[int] = 350  # of memory: states, lists, queue

    number: int | None = param(None, doc="how many", symbol="N", ge=1, le=MOST_PARTICLES)
    density: float | None = param(
        None, doc="number per area or volume", unit="1/length^d", gt=0, le=1e15
    )
    packing_fraction: float | None = param(
        None,
        doc="part of the box that they fill (0.3 unless a number or density is given)",
        symbol=r"\phi",
        gt=0,
        lt=1,
    )
    kinds: Many[SphereKind] = param(
        (ONE,), doc="their kinds, in the order of their numbers", min_length=1
    )
    kT: float = param(1.0, doc="thermal energy of the start", unit="kT", ge=0, le=1e9)
    gravity: Many[float] = param(
        (),
        doc="acceleration of all, one number for each axis (none unless said)",
        symbol="g",
        unit="length/time^2",
    )
    start: SphereStart = param(LatticeStart(), doc="where they are at first")

    @model_validator(mode="after")
    def _not_twice(self) -> Spheres:
        if self.number is not None and self.density is not None:
            raise ValueError("expected a number or a density, not both")
        return self

    @model_validator(mode="after")
    def _diameters(self) -> Spheres:
        """Fill in the usual diameter, also of the kind that a case without kinds has."""
        usual = self.usual_diameter
        unsaid = ONE if usual == ONE.diameter else SphereKind(usual)
        kinds = tuple(unsaid if kind is ONE else kind.filled_in(usual) for kind in self.kinds)
        object.__setattr__(self, "kinds", kinds)  # of a frozen dataclass, while it is made
        return self

    @property
    def instant_collision(self) -> SphereCollision | None:
        """The rule of collisions that take no time, None where spheres act by forces."""
        return None

    @property
    def touching(self) -> bool:
        """Whether contacts last, and have forces that an engine lists (`contacts`)."""
        return False

    @property
    def pair_friction(self) -> float:
        """Coulomb's coefficient of contacts between two of them, 0 without."""
        return 0.0

    @property
    def energy_source(self) -> Heating | None:
        """The source of energy at fixed times, None without."""
        return None

    @property
    def thermostatted(self) -> bool:
        """Whether a thermostat acts in every step."""
        return False

    @property
    def usual_diameter(self) -> float:
        """The diameter of kinds without one."""
        return 1.0

    @field_validator("gravity")
    @classmethod
    def _sane(cls, gravity: tuple[float, ...]) -> tuple[float, ...]:
        if gravity and len(gravity) not in (2, 3):
            raise ValueError("expected one number for each axis")
        if any(abs(x) > STRONGEST for x in gravity):
            raise ValueError(f"expected numbers of at most {STRONGEST:g}")
        return gravity if any(gravity) else ()

    def check(self, box: Box) -> None:
        """Raise CaseError for a bad number of axes or spheres in this box."""
        d = box.dimension
        if self.gravity and len(self.gravity) != d:
            raise CaseError(
                f"spheres.gravity = {show(self.gravity)}: expected {d} numbers, one for each axis"
            )
        count, (where, given) = self.count(box), self._amount()
        if not 1 <= count <= MOST_PARTICLES:
            said = where if given is None else f"{where} = {show(given)}"
            raise CaseError(
                f"{said}: {count_text(count)} spheres in this box; expected 1 to {MOST_PARTICLES}"
            )
        if self.fraction(box) >= 1:
            raise CaseError(
                f"spheres: {count_text(count)} of these diameters would fill "
                f"{self.fraction(box):.3g} of the box; expected less than 1"
            )
        if self.hard:
            self.require_room(box)

    def _amount(self) -> tuple[str, float | None]:
        """The key of the amount of spheres, and its value."""
        key = next((key for key in AMOUNTS if getattr(self, key) is not None), AMOUNTS[-1])
        return f"spheres.{key}", getattr(self, key)

    def require_memory(self, box: Box) -> None:
        """Raise CaseError where this machine cannot hold them: when a run begins, not before."""
        count, (where, given) = self.count(box), self._amount()
        require_memory(where, count if given is None else given, count * self.bytes_each)

    def require_room(self, box: Box) -> None:
        """Raise CaseError for equal spheres denser than the closest packing."""
        spread = any(kind.spread for kind in self.kinds)
        equal = not spread and len({kind.diameter for kind in self.kinds}) == 1
        found, most = self.fraction(box), closest_packing(box.dimension)
        if equal and found > most:
            raise CaseError(
                f"spheres: a packing fraction of {found:.4g}; expected at most {most:.4f}, that of "
                "the closest packing"
            )

    def count(self, box: Box) -> int:
        """How many there are.

        >>> Spheres(number=870).count(Box([32, 32]))
        870
        """
        if self.number is not None:
            return self.number
        if self.density is not None:
            return round(self.density * box.volume)
        wanted = USUAL_FRACTION if self.packing_fraction is None else self.packing_fraction
        return round(wanted * box.volume / self._mean_volume(box.dimension))

    def counts(self, box: Box) -> list[int]:
        """How many there are of each kind.

        >>> Spheres(number=10, kinds=[SphereKind(share=2), SphereKind()]).counts(Box([9, 9]))
        [7, 3]
        """
        total = math.fsum(kind.share for kind in self.kinds)
        ends, up_to = [0], 0.0
        for kind in self.kinds:
            up_to += kind.share / total
            ends.append(round(self.count(box) * up_to))
        return [after - before for before, after in itertools.pairwise(ends)]

    def scale(self, box: Box) -> float:
        """The factor of all diameters, 1 unless number and packing fraction are both given.

        >>> disks = Spheres(number=870, packing_fraction=0.67)
        >>> round(disks.scale(Box([32, 32])) ** 2 * 870 * math.pi / 4 / 32**2, 12)
        0.67
        """
        given = self.number is not None or self.density is not None
        if not given or self.packing_fraction is None:
            return 1.0
        filled = self._filled(box)
        return float((self.packing_fraction * box.volume / filled) ** (1 / box.dimension))

    def fraction(self, box: Box) -> float:
        """The packing fraction, by the mean volume of each kind."""
        return float(self._filled(box) * self.scale(box) ** box.dimension / box.volume)

    def largest(self, box: Box) -> float:
        """The largest diameter that there may be.

        >>> Spheres(number=4, kinds=[SphereKind(2.0, spread=0.5)]).largest(Box([9, 9]))
        3.0
        """
        return max(kind.diameter * (1 + kind.spread) for kind in self.kinds) * self.scale(box)

    def _filled(self, box: Box) -> float:
        unit = ball_volume(box.dimension, 1.0)
        pairs = zip(self.kinds, self.counts(box), strict=True)
        return unit * math.fsum(n * kind.mean_power(box.dimension) for kind, n in pairs)

    def _mean_volume(self, dimension: int) -> float:
        total = math.fsum(kind.share for kind in self.kinds)
        mean = math.fsum(kind.share * kind.mean_power(dimension) for kind in self.kinds) / total
        return ball_volume(dimension, 1.0) * mean
