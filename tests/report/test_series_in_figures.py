"""Figures of numbers in time: conserved quantities, molecules, labels that fit."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
import pytest

from mesokit import Comparison
from mesokit.observe import Result
from mesokit.report import plot
from tests.helpers.fake_fluid import FakeFluid


def test_momentum_of_a_driven_flow_has_its_theory(make_case):
    """And a number of particles that stays needs no panel."""
    from mesokit import Conservation, Plates, Uniform
    from mesokit.method.mpcd.expected.setting import transport

    case = make_case((12, 10), [Conservation()], [Plates("y")], force=Uniform([0.01, 0]))
    accumulator, fluid = Conservation().accumulator(case), FakeFluid(case)
    for _ in range(5):
        fluid.advance(1)
        accumulator.observe(fluid)
    result = accumulator.result()
    nu, mass = transport(case).viscosity, case.particles * case.fluid.mass
    np.testing.assert_allclose(result.expected[:, 1], mass * 0.01 * 10**2 / (12 * nu), rtol=1e-12)
    np.testing.assert_allclose(result.expected[:, 2], 0, atol=1e-12)
    figure = plot(result)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert len(labels) == 3 and "the flow" in labels[2]
    assert labels[0].startswith("momentum") and not labels[0].startswith("momentum\nchange")
    assert f"$N = {case.particles}$" in figure.axes[0].get_title("left")
    assert figure.axes[0].get_legend().get_texts()[-1].get_text() == "theory"


def energies(time):
    """A conservation result with rounding errors of momentum, and energies that cancel."""
    names = ["number", "momentum_x", "momentum_y", "potential_energy", "kinetic_energy"]
    swing = 3 * np.sin(time)
    value = np.stack(
        [0 * time + 900, 2e-10 * time, -1e-10 * time, 50 + swing, 850 - swing, 1 + 0.01 * swing],
        axis=1,
    )
    still = np.where(np.arange(6) < 3, value[0], np.nan * value)
    units = {n: "m a^2/tau^2" if "energy" in n else "m a/tau" for n in names}
    return Result(
        "conservation", "conservation",
        {"time": time, "component": np.array([*names, "temperature"])}, value, np.nan * value,
        "conserved quantities",
        units | {"value": "", "time": "tau", "number": "", "temperature": "m a^2/tau^2"},
        expected=still, samples=len(time),
        extra={"conserves_momentum": 1, "conserves_energy": 1}, drawing="series",
    )  # fmt: skip


def test_conserved_quantities_with_a_potential_have_their_total():
    """And no label runs into another or out of the figure."""
    figure = plot(energies(np.linspace(0, 20, 60)))
    figure.draw_without_rendering()
    labels = [ax.yaxis.label.get_window_extent() for ax in figure.axes]
    assert len(labels) == 4
    for above, below in itertools.pairwise(labels):
        assert not above.overlaps(below)
    assert all(box.x0 >= 0 and box.y0 >= 0 and box.y1 <= figure.bbox.y1 for box in labels)
    parts, total = figure.axes[1:3]
    assert [text.get_text() for text in parts.get_legend().get_texts()] == ["kinetic", "potential"]
    assert "total" in total.get_ylabel() and r"m\,a/\tau" in figure.axes[0].get_ylabel()
    np.testing.assert_allclose(total.lines[-1].get_ydata(), 0, atol=1e-12)
    assert list(total.lines[0].get_ydata()) == [0, 0] and len(total.lines[-1].get_ydata()) == 60


def test_energy_that_is_not_conserved_has_no_change_since_a_chance_sample():
    time = np.linspace(0, 20, 60)
    driven = dataclasses.replace(energies(time), extra={"conserves_momentum": 0})
    total = plot(driven).axes[2]
    np.testing.assert_allclose(total.lines[-1].get_ydata(), 1.0)
    assert "of a particle" in total.get_ylabel()


@pytest.mark.parametrize("drawing", ["displacement", "flow"])
def test_labels_are_no_longer_than_their_axes(drawing):
    if drawing == "flow":
        time = np.linspace(0, 20, 60)
        flow = {"conserves_momentum": 0, "driven": True}
        figure = plot(dataclasses.replace(energies(time), extra=flow))
    else:
        time = np.array([0.0, 1.0, 10.0])
        figure = plot(Result(
            "mean-square-displacement", "d", {"time": time}, 4 * time, 0.1 * time,
            "mean square displacement", {"value": "length^2", "time": "time"}, expected=4 * time,
            comparisons=5 * (Comparison("diffusion coefficient", 1.0, 0.1),),
            drawing="displacement", extra={"components": "xy"},
        ))  # fmt: skip
    figure.draw_without_rendering()
    for ax in figure.axes:
        assert ax.yaxis.label.get_window_extent().height <= ax.bbox.height


def test_what_is_not_known_of_molecules_has_no_panel():
    """Under shear the centre along the flow."""
    names = np.array(["gyration", "x", "vx"])
    value = np.random.default_rng(2).normal(size=(30, 2, 3))
    value[..., 1] = np.nan
    result = Result(
        "molecule-tracks", "tracks",
        {"time": np.arange(30.0), "molecule": np.arange(2), "component": names}, value,
        np.nan * value, "molecules", {"time": "tau", "gyration": "a", "x": "a", "vx": "a/tau"},
        samples=30, extra={"axis": "x", "ideal_gyration": np.nan}, drawing="tracks",
    )  # fmt: skip
    labels = [ax.get_ylabel() for ax in plot(result).axes]
    assert len(labels) == 2 and not any("centre" in label for label in labels)
