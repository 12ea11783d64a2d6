"""In how many sub-steps bodies move, and beads of solutes beside them."""

import math

from mesokit.case.case import Case
from mesokit.method.mpcd.columns import kinds_of_bodies

PHASE = 0.1  # of the fastest motion of bodies, in radians per sub-step


def needed_substeps(case: Case) -> int:
    """Sub-steps in which the stiffest spring or gap turns by PHASE at most, and no fewer than
    solutes take, which move in the same ones."""
    fast, kT, solutes, least = 0.0, case.fluid.kT, case.solutes, 1
    if solutes is not None:
        least = solutes.number_of_substeps(case.box.dimension, case.fluid)
    for kind, mass in zip(case.bodies, (one.mass for one in kinds_of_bodies(case)), strict=True):
        # the curvature where two bodies have one kT of the potential
        s = kind.interaction.range / 2 ** (1 / 6)
        stiffness = 100.0 * kind.interaction.depth * kT / s**2
        fast = max(fast, stiffness * 2.0 / mass)
        if solutes is not None:
            fast = max(fast, stiffness * (1.0 / mass + 1.0 / min(solutes.masses)))
        if kind.trap is not None:
            fast = max(fast, kind.trap.k * kT / mass)
            solid = kind.solid(case.box.dimension)
            fast = max(fast, kind.trap.angular * kT / (mass * solid.moments[2, 2] / solid.volume))
    return max(least, math.ceil(math.sqrt(fast) * case.fluid.timestep / PHASE))
