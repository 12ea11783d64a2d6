"""Estimated cost of event-driven dynamics and of soft spheres, and the summary that shows it.

The constants were measured on 2026-11-23 on one core of an AMD EPYC (`examples/which_method.py`);
estimates are good to a factor of two, ratios of the two methods too.
"""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from mesokit import theory
from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.method.spheres.common.section import Spheres
from mesokit.seam.method import Row, Summary

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
    """Free flight at the start: number of spheres and number per volume; dimension; diameter; mean
    speed; rate: collisions of a sphere per time."""

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
    """Free flight by Enskog of spheres that are the mean of their kinds; None if kT is 0.

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
    return flight.number * (0.5 * flight.rate * COLLISION[d] + flight.renewals * RENEWAL[d])


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


def summary_of(
    case: Case,
    own: Iterable[Row],
    beside: Iterable[Row],
    numbers: dict[str, Any],
    note: str,
    warnings: Iterable[str],
) -> Summary:
    """The summary with the rows of a method; `beside`: rows on the cost of the other method.

    `numbers` has "packing_fraction" and "seconds"; `note` is on the run time.
    """
    section, seconds = case.spheres, numbers["seconds"]
    memory = case.particles * section.bytes_each + 200_000_000
    stored = stored_bytes(case.trajectory, case.groups, case.box.dimension, case.run.steps)
    rows = [
        ("spheres", f"{case.particles:,}".replace(",", " "), ""),
        ("packing fraction", number(numbers["packing_fraction"]), ""),
        *own,
        ("run time", duration_text(max(seconds, 0.1)), note),
        *beside,
        ("memory", size_text(memory), "estimate"),
        *([("trajectory", size_text(stored), "estimate")] if stored else []),
    ]
    warnings = (*run_warnings(case, memory, stored), *warnings)
    return Summary(tuple(rows), warnings, seconds, numbers, memory)
