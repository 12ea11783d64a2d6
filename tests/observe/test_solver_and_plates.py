"""Observables of rigid grains alone: sweeps and residual of the solver, and motion of plates."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    EnergyBudget,
    PackingFraction,
    PlateMotion,
    Plates,
    Run,
    RunError,
    Simulation,
    SolverResidual,
    Surface,
    SurfaceContact,
)
from mesokit.method.spheres.rigid.engine.engine import Solved
from tests.helpers.comparisons import by_name
from tests.helpers.rigid_grains import rigid

CLOSING = Surface(contact=SurfaceContact(speed=0.2, travel=1.0))


def case_of(*observe, number=30, **walls):
    """Disks between plates across y."""
    engine = rigid((8, 12), [Plates("y", **walls)], number=number, timestep=0.01)
    section, walls = engine.case.spheres, engine.case.walls
    run = Run(1000, method="contact-dynamics")
    return Case(run=run, box=Box((8, 12)), spheres=section, walls=walls, observe=list(observe))


def ran(case):
    simulation = Simulation(case)
    simulation.run()
    return simulation.results


def test_sweeps_residual_and_the_share_of_steps_with_all_sweeps():
    case = case_of(SolverResidual(every=10))
    most = case.spheres.solver.sweeps
    accumulator = case.observe[0].accumulator(case)
    sweeps = [2, most, 4, most, most, 6, 8, most] * 4
    for k, in_step in enumerate(sweeps):
        solved = Solved(in_step, 50 * k, 1e-3 * (1 + k % 2), 1.0, 0.02)
        now = {"time": 0.1 * k, "step": 10 * k, "solved": solved}
        accumulator.observe(SimpleNamespace(**now, diameters=lambda: np.full(3, 2.0)))
    result = accumulator.result()
    found = by_name(result)
    assert found["mean sweeps in a step"].measured == pytest.approx(5.0)  # 50 in ten steps
    assert found["mean residual"].measured == pytest.approx(np.mean([2e-3, 1e-3] * 15 + [2e-3]))
    shared = found["share of steps with all sweeps"]
    assert shared.measured == pytest.approx(np.mean([s == most for s in sweeps[1:]]))
    assert shared.error > 0 and "softer than rigid" in shared.note
    assert found["largest overlap at the end"].measured == pytest.approx(0.01)  # over 2
    np.testing.assert_allclose(result.value[:, 0], sweeps)


def test_a_plate_moves_its_travel_and_the_packing_is_that_of_the_room_left():
    case = case_of(PlateMotion(every=100), PackingFraction(every=100), upper=CLOSING)
    results = ran(case)
    moved, filled = (by_name(results[name]) for name in ("plate-motion", "packing-fraction"))
    room = case.spheres.fraction(case.box)
    assert moved["displacement of plates-1-upper"].measured == pytest.approx(1.0)
    between = moved["packing fraction between the plates at the end"].measured
    assert between == pytest.approx(room * 12 / 11, rel=1e-12)
    times = results["plate-motion"].x["time"]
    np.testing.assert_allclose(
        results["plate-motion"].value[:, 0], np.minimum(0.2 * np.asarray(times), 1.0), atol=1e-12
    )
    box = filled["packing fraction of the box"]
    assert box.measured == pytest.approx(room, rel=1e-12) and box.error == 0
    assert "plate-motion" in box.note


def test_plates_that_meet_end_the_run_in_a_line():
    meeting = Surface(contact=SurfaceContact(speed=1.2))  # after 10 along 12: the whole way
    with pytest.raises(
        RunError, match=r"too little room at a time of 10, none; expected a smaller"
    ):
        ran(case_of(PlateMotion(every=100), number=1, upper=meeting))


def test_no_books_of_energy_are_expected_to_close_in_a_sheared_box():
    given, budget = case_of(), EnergyBudget()
    notes = [
        budget.accumulator(replace(given, walls=[], box=box)).work()
        for box in (Box((8, 12)), Box((8, 12), shear_rate=0.1))
    ]
    assert notes == ["", "less the work of the shear of the box"]


def test_plates_at_rest_have_no_note():
    results = ran(case_of(PackingFraction(every=100)))
    assert by_name(results["packing-fraction"])["packing fraction of the box"].note == ""
