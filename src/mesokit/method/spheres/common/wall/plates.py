"""What plates around spheres may do: move along themselves, and vibrate where there is room."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mesokit.case.component import show
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.case.case import Case


def check(case: Case) -> None:
    """Raise CaseError for plates that push spheres out of the box, or move where they stay."""
    box, largest = case.box, case.spheres.largest(case.box)
    for i, wall in enumerate(case.walls):
        for axis in wall.closed_axes:
            k, key = box.index(axis), f"wall[#{i + 1}]"
            surfaces = wall.surfaces()
            for side, surface in surfaces.items():
                velocity = surface.velocity or ()
                if any(velocity[k : k + 1]):
                    raise CaseError(
                        f"{key}.{side}.velocity = {show(list(velocity))}: a plate "
                        f"across {axis} moves only along itself; expected 0 there "
                        "(contact.amplitude makes it vibrate)"
                    )
            moved = [s.contact.amplitude for s in surfaces.values() if s.contact is not None]
            left = box.size[k] - math.fsum(moved)
            if left < largest and any(moved):
                raise CaseError(
                    f"{key}: contact.amplitude = {' and '.join(f'{x:g}' for x in moved if x)}: "
                    f"leaves {max(left, 0.0):.3g} along {axis} to spheres of {largest:g}; expected "
                    f"less than {box.size[k] - largest:.3g} in all"
                )
