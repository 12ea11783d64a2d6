"""Why a run of rigid grains ends before its last step: grains too fast for one, or without room."""

import math
from typing import NamedTuple

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import name_of, show
from mesokit.geometry.walls import surfaces
from mesokit.method.spheres.common.checks import open_falls
from mesokit.method.spheres.common.cost import AT_REST_FILLED
from mesokit.method.spheres.rigid import scales
from mesokit.seam.engine import Array

PRESSED = 0.9  # of the packing fraction at rest, from which grains bear forces all through
SLOW = 0.5  # of the speed of the fastest grain: a plate as fast as that has thrown it


class Now(NamedTuple):
    """Grains and plates after a step, which ends at `time`. speeds (n,): of grains; pushed
    (surfaces,): speeds of plates that are pushed, 0 of others; filled: packing fraction between
    plates as they have moved, infinite where no room is left."""

    time: float
    speeds: Array
    pushed: Array
    filled: float


def too_fast(case: Case, now: Now) -> str:
    """A line that names the fastest grain, the cause, and what to change."""
    grain = int(np.argmax(np.nan_to_num(now.speeds, nan=np.inf)))
    speed = float(now.speeds[grain])
    return (
        f"at a time of {now.time:.4g} grain {grain} moves at {speed:.3g}, so fast that it passes "
        f"others within a step: {_cause(case, now, speed)}"
    )


def no_room(case: Case, now: Now) -> str:
    """A line if plates of a given speed leave grains less room than they fill; nothing if not."""
    driven = [key for key, face, _ in surfaces(case) if face.contact and face.contact.speed > 0]
    if not driven or now.filled <= scales.CLOSEST[case.box.dimension]:
        return ""
    room = f"a packing fraction of {now.filled:.3g}" if math.isfinite(now.filled) else "none"
    return (
        f"plates leave grains too little room at a time of {now.time:.4g}, {room}; expected a "
        f"smaller {driven[0]}.contact.travel"
    )


def _cause(case: Case, now: Now, speed: float) -> str:
    solver, named = case.spheres.solver, list(surfaces(case))
    if not solver.settles:
        return (
            "errors of forces grow from sweep to sweep with spheres.solver.rule = "
            f"{show(name_of(solver))}; expected a smaller relaxation, or rule 'gauss-seidel'"
        )
    if squeezed := no_room(case, now):
        return squeezed
    driven = [key for key, face, _ in named if face.contact and face.contact.speed > 0]
    if driven and now.filled > PRESSED * AT_REST_FILLED[case.box.dimension]:
        return (
            f"plates press grains together, to a packing fraction of {now.filled:.3g}; expected a "
            f"smaller {driven[0]}.contact.travel, or a lower contact.speed"
        )
    opened = [i for i, wall in enumerate(case.walls) if (wall.opens or math.inf) <= now.time]
    falls = open_falls(case, now.time) if opened else []
    if falls:
        return (
            f"nothing ends the fall along {falls[0]} since wall[#{opened[-1] + 1}] has opened; "
            "expected a wall below, or fewer run.steps"
        )
    fastest = int(np.argmax(np.append(np.abs(now.pushed), 0.0)))
    if fastest < len(named) and abs(now.pushed[fastest]) > SLOW * speed:
        return (
            f"{named[fastest][0]}, which is pushed, moves at {abs(now.pushed[fastest]):.3g}; "
            "expected a larger contact.mass of it, or a shorter spheres.timestep"
        )
    step, longest = scales.timestep_of(case), scales.longest_step(case, speed)
    return f"expected a spheres.timestep below {longest:.3g}, not {step:.3g}"
