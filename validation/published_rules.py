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
from moving_bodies import STEP, case_of

from mesokit import BodyMotion, Case, DiskBody, SphereBody
from mesokit.method.mpcd.engine.bodies import gas, hits
from mesokit.method.mpcd.engine.bodies.linear import X
from mesokit.scalar.jit import seldom

RULE_SETS = {"hits": (hits,), "gas": (gas,), "both": (hits, gas)}
SHARE = 0.6  # of the steps, in runs with published rules
CASES = ("sphere-srd", "disk-at+a")


def case_of_published(name: str, share: float = 1.0) -> Case:
    """One of `CASES`, with the steps of the run with rules of the program times a share."""
    if name == "sphere-srd":
        return case_of(SphereBody(radius=2), 12, "srd", share * 5e4, BodyMotion(), timestep=STEP)
    return case_of(DiskBody(radius=2), 16, "at+a", share * 1.2e5, BodyMotion(), timestep=STEP)


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
    for name in CASES:
        page.run(f"published-{which}-{name}", case_of_published(name, SHARE))


if __name__ == "__main__":
    if "NUMBA_CACHE_DIR" not in os.environ:
        sys.exit("NUMBA_CACHE_DIR: missing; code with other rules needs a folder of its own")
    main(sys.argv[1])
