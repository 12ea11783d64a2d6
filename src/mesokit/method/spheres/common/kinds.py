"""Kinds of spheres: how large, how heavy, how many."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING

from pydantic import model_validator

from mesokit.case.component import component, param

if TYPE_CHECKING:
    Diameter = float  # a section of spheres fills it in
else:
    Diameter = float | None


@component
class SphereKind:
    """Spheres (disks in 2D) of one distribution of diameters, all of the same material.

    Examples
    --------
    >>> SphereKind(diameter=2.0, density=1.0).mean_mass(2) == math.pi
    True
    """

    diameter: Diameter = param(
        None,
        doc="diameter, or the middle of them (that of the potential if one acts, else 1, unless "
        "said)",
        unit="length",
        gt=0,
        le=1e9,
    )
    share: float = param(1.0, doc="how many, in proportion to other kinds", gt=0, le=1e9)
    spread: float = param(
        0.0, doc="diameters are uniform within this part of the middle on both sides", ge=0, lt=1
    )
    mass: float | None = param(
        None, doc="mass of a sphere of that diameter (1 unless said)", unit="mass", gt=0, le=1e9
    )
    density: float | None = param(
        None,
        doc="mass per volume, or per area in 2D, in place of the mass",
        unit="mass/length^d",
        gt=0,
    )
    name: str | None = param(None, doc="name in results and files", min_length=1)

    @model_validator(mode="after")
    def _one_of_both(self) -> SphereKind:
        if self.mass is not None and self.density is not None:
            raise ValueError("expected a mass or a density, not both")
        return self

    def filled_in(self, diameter: float) -> SphereKind:
        """The same with a diameter, where it has none.

        >>> SphereKind(mass=2.0).filled_in(0.5).diameter
        0.5
        """
        return self if self.diameter is not None else dataclasses.replace(self, diameter=diameter)

    def mean_mass(self, dimension: int) -> float:
        """Mass of a sphere of the middle diameter."""
        if self.density is not None:
            return self.density * ball_volume(dimension, self.diameter)
        return 1.0 if self.mass is None else self.mass

    def mean_power(self, power: int) -> float:
        """Mean of a power of the diameter.

        >>> round(SphereKind(diameter=2.0, spread=0.5).mean_power(2), 6)
        4.333333
        """
        low, high = 1.0 - self.spread, 1.0 + self.spread
        if self.spread == 0.0:
            return self.diameter**power
        mean = (high ** (power + 1) - low ** (power + 1)) / ((power + 1) * 2 * self.spread)
        return mean * self.diameter**power


def closest_packing(dimension: int) -> float:
    """The largest part of space that equal disks, or spheres, can fill (Hales 2005 in 3D).

    >>> round(closest_packing(2), 4), round(closest_packing(3), 4)
    (0.9069, 0.7405)
    """
    return math.pi / math.sqrt(12 if dimension == 2 else 18)


def ball_volume(dimension: int, diameter: float) -> float:
    """Area of a disk, or volume of a sphere.

    >>> ball_volume(3, 2.0) == 4 * math.pi / 3
    True
    """
    return math.pi * diameter**dimension / (4 if dimension == 2 else 6)
