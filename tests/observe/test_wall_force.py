"""Forces on walls, and what spheres have of momentum at the end of a run."""

import dataclasses

import numpy as np

from mesokit import Plates, Run, Simulation, WallForce
from tests.helpers.fake_spheres import hard

SEEDS = 16


def forces(seed, gravity):
    """Of a thermal gas of 20 disks between two plates that both are hit."""
    fall = {"gravity": (0, -gravity), "walls": [Plates("y")], "packing_fraction": None}
    case = hard([WallForce(every=2)], (9, 9), timestep=0.2, kT=2.0, **fall)
    run = Run(400, 50, seed=seed, method="event-driven")
    simulation = Simulation(dataclasses.replace(case, run=run), threads=1)
    simulation.run()
    return simulation["wall-force"]


def test_the_weight_is_exact_and_plates_scatter_as_their_error_bars_say():
    found = [forces(seed, 0.3) for seed in range(SEEDS)]
    for result in found:
        (total,) = result.comparisons
        assert total.error == 0.0 and abs(total.measured / total.expected - 1) < 1e-9
        assert "weight" in total.note
    values = np.array([result.value[:, 1] for result in found])
    errors = np.array([result.error[:, 1] for result in found])
    root = values.std(axis=0, ddof=1) / np.sqrt((errors**2).mean(axis=0))
    assert (root > 0.6).all() and (root < 1.5).all()  # the scatter of 16 is known to 18 %
