"""Plates around spheres may vibrate where there is room."""

import math

from mesokit.case.case import Case
from mesokit.errors import CaseError


def check_plates(case: Case) -> None:
    """Raise CaseError for plates that move where spheres stay."""
    box, largest = case.box, case.spheres.largest(case.box)
    for i, wall in enumerate(case.walls):
        for axis in wall.closed_axes:
            k, key = box.index(axis), f"wall[#{i + 1}]"
            contacts = [surface.contact for surface in wall.surfaces().values()]
            moved = [contact.amplitude for contact in contacts if contact is not None]
            left = box.size[k] - math.fsum(moved)
            if left < largest and any(moved):
                raise CaseError(
                    f"{key}: contact.amplitude = {' and '.join(f'{x:g}' for x in moved if x)}: "
                    f"leaves {max(left, 0.0):.3g} along {axis} to spheres of {largest:g}; expected "
                    f"less than {box.size[k] - largest:.3g} in all"
                )
