"""Base of the starts of spheres: places, and velocities where they are not to be drawn."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from mesokit.case.case import Case
from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.method.spheres.common.made import Made
from mesokit.seam.engine import Array


class Placed(NamedTuple):
    """By particle number: positions (n, d), and velocities (n, d) and spins ((n,) in 2D, (n, 3) in
    3D) unless they are to be drawn; diameters (n,) where the start brings its own."""

    positions: Array
    velocities: Array | None = None
    spins: Array | None = None
    diameters: Array | None = None


@family("start of spheres", "rule", "mesokit.sphere_start")
@component
class SphereStart(ABC):
    """A rule for the first places of spheres."""

    def check(self, case: Case) -> None:  # noqa: B027  # most can begin anywhere
        """Raise CaseError where there is no room for all."""

    @abstractmethod
    def place(self, case: Case, made: Made) -> Placed:
        """Places for all spheres, none on another. Raises CaseError if there is no room."""

    def files(self) -> Mapping[str, Path]:
        """The files and folders of runs that it reads, by key."""
        return {}
