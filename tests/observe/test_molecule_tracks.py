"""Molecules in time: what is kept of each, and error bars that hold however short the run."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import BondLength, MoleculeHistogram, MoleculeSize, MoleculeTracks
from mesokit.method.mpcd.expected.molecules import modes_at_rest
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from tests.helpers.fake_molecules import case_with, followed

TURN = np.radians(60)


def test_a_rod_that_turns_and_goes():
    observable = MoleculeTracks()
    case = case_with(observable, length=3)
    times = 0.5 * np.arange(8)
    way = np.stack([[30.0, 0.0] + t * np.array([7.0, 0.0]) for t in times])
    rod = np.stack([-1.0, 0.0, 1.0])[:, None] * [np.cos(TURN), np.sin(TURN)] * 2
    tracks = followed(observable, case, times, (way[:, None] + rod)[:, None]).result()
    of = {str(name): tracks.value[:, 0, k] for k, name in enumerate(tracks.x["component"])}
    np.testing.assert_allclose(tracks.x["time"], times)
    np.testing.assert_allclose(of["gyration"], np.sqrt(8 / 3))
    np.testing.assert_allclose(of["end-to-end"], 4)
    np.testing.assert_allclose([of["Rx"][0], of["Ry"][0]], [2, 2 * np.sqrt(3)])
    np.testing.assert_allclose(of["orientation"], 2 * np.cos(TURN) ** 2 - 1)
    np.testing.assert_allclose(of["x"], way[:, 0])  # through one box after the other
    assert tracks["mean square end-to-end distance"].measured == pytest.approx(16)
    # ideal: (n - 1) <b^2> and its share (n + 1)/(6 n), with <b^2> = d kT/(2 K); and what sub-steps
    # of velocity Verlet add to each mode
    first, second = (modes_at_rest(case).eigenvalues[1:] / (1.0, 3.0)).tolist()
    assert 0.99 < second < first < 1
    bond = 2 / 3
    assert tracks["mean square end-to-end"].expected == pytest.approx(2 * bond / first)
    gyration = bond / 3 * (1 / first + 1 / (3 * second))
    assert tracks["mean square radius"].expected == pytest.approx(gyration)


def test_molecules_that_never_change_still_scatter():
    """Blocks of time alone would say that the mean is exact."""
    rng = np.random.default_rng(3)
    ends = rng.normal(size=(300, 2))
    beads = np.stack([np.zeros((300, 2)), ends], axis=1)
    observable = MoleculeTracks(molecules=300)
    case = case_with(observable, number=300)
    found = followed(observable, case, np.arange(20.0), [beads] * 20).result()
    size = found["mean square end-to-end"]
    assert 0.6 < size.error / (2 / np.sqrt(300)) < 1.4  # <R^4> = 2 <R^2>^2 in 2D
    assert abs(size.measured - 2) < 4 * size.error


def test_pooled_molecules_are_those_of_all_runs():
    one, other = MeansOverMolecules(6, 1), MeansOverMolecules(6, 1)
    for _ in range(8):
        one.add(np.arange(6.0)[:, None])
        other.add(np.arange(6.0, 12.0)[:, None])
    one.pool(other)
    assert one.mean()[0] == pytest.approx(5.5)
    assert one.error()[0] >= np.arange(12.0).std(ddof=1) / np.sqrt(12) - 1e-12


def test_a_long_run_says_that_its_rows_are_means():
    import dataclasses

    observable = MoleculeTracks(molecules=1000, every=1)
    case = case_with(observable, number=1000, length=2)
    long = dataclasses.replace(case, run=dataclasses.replace(case.run, steps=20_000))
    assert not list(observable.warnings(case))
    [said] = observable.warnings(long)
    assert "every = 1: 20001 samples of 1000 molecules" in said


def caught(observable, molecules, seed, samples=24):
    """Chains of two beads whose ends (2D, of variance 1) stay as they start."""
    ends = np.random.default_rng(seed).normal(size=(molecules, 2))
    beads = np.stack([np.zeros_like(ends), ends], axis=1)
    case = case_with(observable, number=molecules)
    return followed(observable, case, np.arange(float(samples)), [beads] * samples)


@pytest.mark.parametrize("molecules", [2, 3])
def test_error_bars_of_few_molecules_hold(molecules):
    """Two or three that do not change: their scatter is uncertain itself, and Student knows it."""
    held = 0
    for seed in range(400):
        means = MeansOverMolecules(molecules, 1)
        values = np.random.default_rng(seed).normal(size=(molecules, 1))
        for _ in range(4):
            means.add(values)
        held += abs(means.mean()[0]) < means.error()[0]
    assert abs(held / 400 - 0.683) < 3 * (0.683 * 0.317 / 400) ** 0.5


@pytest.mark.parametrize("kind", [MoleculeTracks, MoleculeHistogram, MoleculeSize, BondLength])
def test_two_molecules_scatter_in_every_observable_of_molecules(kind):
    observable = kind(of="end-to-end") if kind is MoleculeHistogram else kind()
    for molecules in (1, 2):
        found = caught(observable, molecules, seed=5).result().comparisons
        of_ends = next(c for c in found if any(word in c.what for word in ("end-to-end", "bond")))
        if molecules == 2:
            assert of_ends.error > 0.2
        else:
            assert "lower bound" in of_ends.note


def test_what_two_molecules_were_goes_on_after_a_stop():
    observable = MoleculeSize()
    first = caught(observable, 2, seed=5)
    again = caught(observable, 2, seed=6)
    again.restore(first.state())
    assert again.result() == first.result()
