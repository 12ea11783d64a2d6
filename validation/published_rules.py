"""Runs of bodies with published rules of hits and of virtual particles, for the page of bodies.

Usage: python validation/published_rules.py hits|gas|both FOLDER [--short]

These rules are no option of the program: two functions are replaced before anything is compiled.
By the published rule of hits each particle is reflected about the velocity that the body has at the
beginning of the step. By that of virtual particles they have their own thermal velocities beside
the velocity of the body. What is compiled here must not be met by other runs: NUMBA_CACHE_DIR has
to be a folder of its own.
"""

from __future__ import annotations

import os
import sys

from common import Page
from moving_bodies import STEP, AtRest, at_rest

from mesokit.method.mpcd.engine.bodies import gas, hits
from mesokit.method.mpcd.engine.bodies.linear import X
from mesokit.scalar.jit import seldom

RULE_SETS = {"hits": (hits,), "gas": (gas,), "both": (hits, gas)}
SHARE = 0.6  # of the steps, in runs with published rules


def with_published() -> list[AtRest]:
    """The bodies at rest at the usual timestep, and disks and spheres of radius 2 at all."""
    round_ones = ("sphere R = 2", "disk R = 2")
    return [one for one in at_rest() if one.timestep == STEP or one.name in round_ones]


@seldom
def no_change(bodies, i, t, d, scales, work):
    """Nothing is taken into account of all hits, or of all thermal velocities, at once."""
    for a in range(6):
        work[X + a] = 0.0


def main(which: str) -> None:
    """Run all cases with these rules."""
    if hits in RULE_SETS[which]:
        hits.solve_reflection = no_change
    if gas in RULE_SETS[which]:
        gas.solve_noise = no_change
    page = Page("bodies", "")
    for one in with_published():
        page.run(f"published-{which}-{one.key}", one.case(SHARE))


if __name__ == "__main__":
    if "NUMBA_CACHE_DIR" not in os.environ:
        sys.exit("NUMBA_CACHE_DIR: missing; code with other rules needs a folder of its own")
    main(sys.argv[1])
