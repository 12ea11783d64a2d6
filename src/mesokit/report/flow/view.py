"""What a user may say of a picture, and of a film."""

from typing import NamedTuple

from mesokit.report.flow.region import Ranges


class View(NamedTuple):
    """Which part of the box is shown: a region, a window of time, a plane and where it lies.

    `colour` says what the colours of spheres mean, `average` how many frames each picture of a film
    is the mean of.
    """

    region: Ranges | None = None
    window: tuple[float, float] | None = None
    axes: tuple[str, str] | None = None
    at: float | None = None
    colour: str | None = None
    average: int | None = None


CHOICES = View._fields
