"""What spheres cost by event-driven dynamics and as soft spheres: estimates from measured costs.

The constants were measured on 2026-11-23 on one core of an AMD EPYC (`examples/which_method.py`);
estimates are good to a factor of two, ratios of the two methods too.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from mesokit import theory
from mesokit.method.spheres.common.kinds import ball_volume

if TYPE_CHECKING:
    from mesokit.case.box import Box
    from mesokit.case.case import Case
    from mesokit.method.spheres.common.section import Spheres

COLLISION = {2: 0.45e-6, 3: 0.7e-6}  # seconds, of two hard spheres
RENEWAL = {2: 0.7e-6, 3: 1.4e-6}  # seconds, of the list of a hard sphere
LISTED = {2: 10.0, 3: 14.0}  # others on a list of a hard sphere
STEP, NEIGHBOUR, CONTACT = 25e-9, 5e-9, 20e-9  # seconds, of a soft sphere, for each listed, rubbing
LIST_REACH = 1.1  # of lists of soft spheres, in diameters
STEPS = 50  # of soft spheres in a contact
OVERLAP = 0.01  # in diameters: of soft spheres that are as good as hard
FLIGHTS = 10  # contact times in a free flight, at least, of these
AT_REST = ("cheaper", "soft spheres", "once grains rest: hard ones collide ever more often")
AT_REST_FILLED = {2: 0.8, 3: 0.6}  # of the volume of a bed
DENSEST = 0.7  # packing fraction up to which rates are estimated


class Flight(NamedTuple):
    """Spheres as they fly at the start: how many, per volume, in how many dimensions, of which
    diameter; mean speed (per time), and collisions of one per time."""

    number: int
    density: float
    dimension: int
    diameter: float
    speed: float
    rate: float

    @property
    def listed_by_soft(self) -> float:
        """Others on the list of a soft sphere."""
        return self.density * ball_volume(self.dimension, 2 * LIST_REACH * self.diameter)

    @property
    def renewals(self) -> float:
        """Lists of a hard sphere per time: a shell is left by flying, or slower, by diffusion."""
        within = LISTED[self.dimension] / self.density
        reach = self.diameter * (within / ball_volume(self.dimension, 2 * self.diameter)) ** (
            1 / self.dimension
        )
        shell = max(0.5 * (reach - self.diameter), 0.1 * self.diameter)
        return self.speed / (shell * (1 + shell * self.rate / self.speed))


def flight_of(section: Spheres, box: Box) -> Flight | None:
    """Spheres at the start by Enskog, all as the mean of their kinds; None of spheres at rest.

    Examples
    --------
    >>> from mesokit import Box, HardSpheres
    >>> gas = flight_of(HardSpheres(packing_fraction=0.2), Box([60, 60]))
    >>> round(gas.rate, 2), round(gas.speed, 3)
    (1.29, 1.253)
    """
    if section.kT == 0:
        return None
    d, number = box.dimension, section.count(box)
    shares = [count / number for count in section.counts(box)]
    kinds = list(zip(shares, section.kinds, strict=True))
    diameter = sum(share * kind.mean_power(1) for share, kind in kinds) * section.scale(box)
    kT_over_m = section.kT / sum(share * kind.mean_mass(d) for share, kind in kinds)
    phi, density = min(section.fraction(box), DENSEST), number / box.volume
    rate = theory.enskog_rate(density, diameter, kT_over_m, phi, d)
    speed = math.sqrt(kT_over_m * (math.pi / 2 if d == 2 else 8 / math.pi))
    return Flight(number, density, d, diameter, speed, rate)


def hard_seconds(flight: Flight) -> float:
    """Seconds of a core for a unit of time of event-driven dynamics."""
    d = flight.dimension
    each = 0.5 * flight.rate * COLLISION[d] + flight.renewals * RENEWAL[d]
    return flight.number * each


def soft_seconds(number: int, listed: float, rubs: bool) -> float:
    """Seconds of a core for a step of soft spheres with so many others on their lists.

    >>> soft_seconds(1000, 3.0, False)
    4e-05
    """
    return number * (STEP + listed * (CONTACT if rubs else NEIGHBOUR))


def contact_time_as_hard(flight: Flight) -> float:
    """Contact time with which soft spheres are as good as hard: of small overlaps, and short
    against a free flight."""
    # x = v t/pi at the relative speed of two
    by_overlap = math.pi * OVERLAP * flight.diameter / (math.sqrt(2) * flight.speed)
    return min(by_overlap, 1 / (FLIGHTS * flight.rate))


def cheaper(name: str, factor: float) -> tuple[str, str, str]:
    """A row of `mesokit check`: which method is cheaper, and how many times.

    >>> cheaper("event-driven", 1938.0)
    ('cheaper', 'event-driven', 'about 1900 times, in time on one core')
    """
    return "cheaper", name, f"about {float(f'{factor:.2g}'):g} times, in time on one core"


def comes_to_rest(case: Case, loses: bool, heated: bool) -> bool:
    """Whether grains that lose energy where they touch fall, and nothing shakes or heats them."""
    surfaces = [surface for wall in case.walls for surface in wall.surfaces().values()]
    contacts = [surface.contact for surface in surfaces if surface.contact is not None]
    shaken = any(c.amplitude > 0 or c.temperature is not None for c in contacts)
    return bool(case.spheres.gravity) and loses and not (shaken or heated)
