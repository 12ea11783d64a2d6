"""Estimated cost of all methods of spheres, and the summary that shows it.

The constants were measured on one core of an AMD EPYC: those of event-driven dynamics and of soft
spheres on 2026-11-23 (`examples/which_method.py`), those of contact dynamics on 2026-11-28, sweeps
of beds that settle among them (`examples/crossing.py`).
Estimates are good to a factor of two, ratios of two methods too.
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
from mesokit.theory.sweeps import Order

COLLISION = {2: 0.45e-6, 3: 0.7e-6}  # seconds, of two hard spheres
RENEWAL = {2: 0.7e-6, 3: 1.4e-6}  # seconds, of the list of a hard sphere
LISTED = {2: 10.0, 3: 14.0}  # others on a list of a hard sphere
STEP, NEIGHBOUR, CONTACT = 25e-9, 5e-9, 20e-9  # seconds, of a soft sphere, for each listed, rubbing
LIST_REACH = 1.1  # of lists of soft spheres, in diameters
STEPS = 50  # of soft spheres in a contact
OVERLAP = 0.01  # in diameters: of soft spheres that are as good as hard, where they collide
UNDER_WEIGHT = 0.001  # in diameters: and at rest under the weight of all above
FLIGHTS = 10  # contact times in a free flight, at least, of these
SWEPT = {2: 12e-9, 3: 21e-9}  # seconds, of a contact of rigid grains in a sweep
FOUND = {2: 0.4e-6, 3: 0.5e-6}  # seconds, of a rigid grain in a step, for its contacts and flight
CONTACTS = {2: 1.8, 3: 2.4}  # of rigid grains in a bed, for each grain, near ones included
SWEEPS = 500  # most in a step, unless said
ACCURACY = 1e-4  # of the forces of rigid grains, unless said
AS_COLUMN = {2: 1.4, 3: 4.0}  # sweeps of a bed that settles, over those of a column as high
NAMES = {
    "event-driven": "event-driven",
    "soft-spheres": "soft spheres",
    "contact-dynamics": "contact dynamics",
}
LASTING = 2.0  # sweeps in a step of grains at rest, whose forces last
SETTLES = 2.2  # times of a fall through the box, after which poured grains are at rest
STEPS_OF_FALL = 100  # of rigid grains, while one falls by its diameter
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


def rigid_seconds(number: int, contacts: float, sweeps: float, dimension: int) -> float:
    """Seconds of a core for a step of rigid grains with so many contacts and sweeps.

    >>> round(rigid_seconds(1000, 1800.0, 100.0, 2), 6)
    0.00256
    """
    return number * FOUND[dimension] + contacts * sweeps * SWEPT[dimension]


def sweeps_in_bed(
    number: int, dimension: int, accuracy: float = ACCURACY, order: Order = "coloured"
) -> float:
    """Sweeps in a step of a bed that settles, if there may be as many.

    >>> round(sweeps_in_bed(300, 2)), round(sweeps_in_bed(300, 3))
    (1691, 725)
    """
    column = theory.packing_sweeps(number, dimension, accuracy, order)
    return AS_COLUMN[dimension] * column


class Bed(NamedTuple):
    """Grains that lie on one another: their number, dimension, mean diameter and mass; strength of
    gravity, and the height of the bed over a diameter."""

    number: int
    dimension: int
    diameter: float
    mass: float
    gravity: float
    layers: float

    def seconds_of_rigid(self, time: float, settling: float) -> float:
        """Seconds of a core for a time of contact dynamics with the usual keys; settling: the part
        of it in which grains move, and forces change."""
        d, step = self.dimension, math.sqrt(2 * self.diameter / self.gravity) / STEPS_OF_FALL
        contacts, sweeps = CONTACTS[d] * self.number, min(sweeps_in_bed(self.number, d), SWEEPS)
        moving = rigid_seconds(self.number, contacts, sweeps, d)
        resting = rigid_seconds(self.number, contacts, LASTING, d)
        return (settling * moving + (1 - settling) * resting) * time / step

    @property
    def stiffness_as_hard(self) -> float:
        """Stiffness with which the lowest of soft spheres overlap by `UNDER_WEIGHT`."""
        return self.mass * self.gravity * max(self.layers, 1.0) / (UNDER_WEIGHT * self.diameter)

    def seconds_of_soft(self, stiffness: float) -> float:
        """Seconds of a core for a unit of time of soft spheres of a stiffness."""
        step = math.pi * math.sqrt(0.5 * self.mass / stiffness) / STEPS
        reach = 2 * LIST_REACH  # of centres, in diameters
        listed = AT_REST_FILLED[self.dimension] * reach**self.dimension
        return soft_seconds(self.number, listed, True) / step

    def stiffness_of_equal_cost(self, rigid: float) -> float:
        """Stiffness from which soft spheres cost more than so many seconds for a unit of time."""
        return (rigid / self.seconds_of_soft(1.0)) ** 2


def bed_of(case: Case) -> Bed:
    """The bed that the grains of a case form, at the side to which they fall."""
    section, box, d = case.spheres, case.box, case.box.dimension
    number = section.count(box)
    kinds = list(zip(section.counts(box), section.kinds, strict=True))
    diameter = sum(n * kind.mean_power(1) for n, kind in kinds) / number * section.scale(box)
    mass = sum(n * kind.mean_mass(d) for n, kind in kinds) / number
    g = math.hypot(*section.gravity)
    pairs = zip(section.gravity or (), box.size, strict=False)
    height = sum(abs(a) / g * length for a, length in pairs) if g > 0 else 0.0
    layers = height * min(section.fraction(box) / AT_REST_FILLED[d], 1.0) / diameter
    return Bed(number, d, diameter, mass, g, layers)


def settling_part(case: Case, time: float) -> float:
    """Part of a time after which grains that fall through the box are at rest."""
    gravity, size = case.spheres.gravity, case.box.size
    strength = math.hypot(*gravity)
    height = sum(abs(g) * length for g, length in zip(gravity, size, strict=True)) / strength
    settles = SETTLES * math.sqrt(2 * height / strength)
    return min(settles / time, 1.0) if time > 0 else 1.0


def cheaper_at_rest(case: Case, time: float, soft: float | None = None) -> tuple[str, Row]:
    """The cheaper method for grains that come to rest within a time, and its row of `mesokit
    check`; hard ones collide ever more often. soft: seconds of soft spheres; stiff ones unless
    given."""
    bed = bed_of(case)
    if soft is None:
        soft = time * bed.seconds_of_soft(bed.stiffness_as_hard)
    rigid = bed.seconds_of_rigid(time, settling_part(case, time))
    name = "soft-spheres" if soft < rigid else "contact-dynamics"
    more, less = max(soft, rigid), min(soft, rigid)
    factor = more / less if less > 0 else 1.0
    return name, ("cheaper", NAMES[name], f"once grains rest, about {factor:.2g} times")


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
