"""Two axes of a box, as all pictures over them have."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.report.flow.data import Array, Flow
from mesokit.report.flow.smooth import rim_filled
from mesokit.report.flow.solids import Section
from mesokit.seam.method import method_of

SURE, LEAST = 0.5, 0.1  # parts of a bin that are fluid, for its colours to count, to be drawn
UNUSUAL = 4.0  # times the median error, above which a bin's colours do not count


@dataclass(frozen=True)
class Setting:
    """Two axes of a box, their numbers `columns`, and whether each is periodic."""

    axes: tuple[str, str]
    columns: list[int]
    size: tuple[float, float]
    dimension: int
    periodic: tuple[bool, bool]
    case: Case | None = None

    @classmethod
    def of(cls, case: Case, axes: tuple[str, str]) -> Setting:
        """That of a case. Images along y move under shear: flow does not go on across them."""
        section = Section(case, axes)
        first, second = (
            not closed and not (case.box.sheared and axis == "y")
            for closed, axis in zip(section.closed(), axes, strict=True)
        )
        width, height = (float(case.box.size[column]) for column in section.columns)
        box = (width, height), case.box.dimension
        return cls(axes, section.columns, *box, (first, second), case)

    def share(self, shape: tuple[int, ...]) -> Array | None:
        """Part of each bin (nx, ny) that is fluid, None where no solid is in the way."""
        solids = None if self.case is None else method_of(self.case).enclosure.solids(self.case)
        if solids is None or not solids.obstruct:
            return None
        if shape not in self._shares:
            self._shares[shape] = solids.open_share((self.columns[0], self.columns[1]), shape)
        return self._shares[shape]

    @cached_property
    def _shares(self) -> dict[tuple[int, ...], Array]:
        return {}

    def flow(self, **arrays: Any) -> Flow:
        """A flow over these axes; densities become those of the open part of each bin.

        Parameters: `arrays`, by their names in `Flow`.
        """
        velocity, density, error = (arrays.get(name) for name in ("velocity", "density", "error"))
        shape = next((a.shape[:2] for a in (velocity, density) if a is not None), None)
        share = None if shape is None else self.share(shape)
        sure = None if share is None else share > SURE
        if error is not None and np.isfinite(error).any():
            largest = np.nan_to_num(error, nan=np.inf).max(axis=-1)
            usual = largest <= UNUSUAL * np.nanmedian(error)
            sure = usual if sure is None else usual & sure
        found = Flow(self.axes, self.size, self.dimension, self.periodic, sure=sure, **arrays)
        if velocity is not None and share is not None:
            found = replace(found, velocity=rim_filled(velocity, share, self.periodic))
        if density is not None and share is not None:
            open_part = np.where(share > LEAST, density / np.maximum(share, LEAST), np.nan)
            found = replace(found, density=open_part)
        return found
