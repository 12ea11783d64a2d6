"""Beads that are pulled, trapped, or charged in a magnetic field."""

import dataclasses

import numpy as np
import pytest
from numba import njit

from mesokit import (
    Box,
    Case,
    DensityProfile,
    Fluid,
    Harmonic,
    MagneticField,
    MeanSquareDisplacement,
    MoleculeHistogram,
    Polymer,
    Pull,
    Run,
    Solutes,
    Trap,
    theory,
)  # fmt: skip
from mesokit.errors import CaseError
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.engine.beads.external import external_of, turned
from tests.helpers.comparisons import comparisons
from tests.helpers.small_fluids import make_fluid, mean


def in_random_solvent(*kinds, size=(12, 12), K=1.0, **parts):
    """Beads in a fluid that forgets: friction and noise alone. With a dimer, for one compiled kind
    of case serves all."""
    solutes = Solutes((*kinds, Polymer(1, length=2)), bond=Harmonic(K=K), solvent="random", **parts)
    return make_fluid(size, solutes=solutes, density=10, timestep=0.1)


def places(fluid, number):
    return fluid.solutes.places[:number].copy()


@pytest.mark.parametrize("d", [2, 3])
def test_a_magnetic_field_turns_at_the_cyclotron_frequency_and_does_no_work(d):
    """dv/dt = (q/m) v x B, solved by SciPy; many small turns are one large one."""
    from scipy.integrate import solve_ivp

    field = np.array([0.0, 0.0, 0.7]) if d == 2 else np.array([0.3, -0.5, 0.7])
    given = Solutes((Polymer(2),), mass=2.0, magnetic=[MagneticField(field, charge=3.0)])
    external = external_of(given, d)
    turn = njit(lambda external, time, i, v: turned(external, time, i, v))
    v = tuple(np.array([0.4, -1.1, 0.8])[:d])
    w, u = turn(external, 2.5, 1, v), v
    for _ in range(50):
        u = turn(external, 0.05, 1, u)
    np.testing.assert_allclose(u, w, atol=1e-12)
    assert np.dot(w, w) == pytest.approx(np.dot(v, v), rel=1e-12)
    start = np.append(v, [0.0] * (3 - d))
    path = solve_ivp(lambda _, v: 1.5 * np.cross(v, field), (0, 2.5), start, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(w, path.y[:d, -1], atol=1e-8)


@pytest.mark.parametrize("turn", [0.15, 2.0])
def test_diffusion_across_a_magnetic_field(turn):
    """Velocities keep the share s in a collision and turn by w in a step: s^n cos(n w); on their
    arcs beads come as far as sin(w/2)/(w/2) of a straight way."""
    number, dt, mass, steps = 600, 0.1, 200.0, 100
    field = MagneticField([0, 0, turn * mass / dt], kind=1)
    # so dilute that no two collide: those that do forget, and diffuse in the strong field
    fluid = in_random_solvent(Polymer(number), size=(900, 900), mass=mass, magnetic=[field])
    free = theory.bead_diffusion("srd", 2, 10, dt, 130, mass)
    share = 1 - theory.decorrelation_from_diffusion(free, dt, 1.0, mass)
    lag = np.arange(1, steps)
    kept = share**lag * np.cos(turn * lag)
    flight = dt * np.sin(turn / 2) / (turn / 2)
    expected = 2 * flight**2 / mass * (steps + 2 * ((steps - lag) * kept).sum())
    assert expected < 0.5 * 4 * free * steps * dt
    fluid.advance(50)
    samples = []
    for _ in range(10):
        r = places(fluid, number)
        fluid.advance(steps)
        samples.append(((places(fluid, number) - r) ** 2).sum(axis=1))
    found = mean(np.concatenate(samples))
    assert found.agrees(expected), (found, expected)


def test_a_trapped_bead_is_spread_as_boltzmann_says():
    trap, number = Trap([6.0, 3.0], k=2.0), 40
    fluid = in_random_solvent(Polymer(number), traps=[trap])
    fluid.advance(2000)
    samples = []
    for _ in range(40):
        fluid.advance(300)
        samples.append(places(fluid, number) - trap.centre)
    # beads of one cell collide with one another: one number of each sample
    squares = [(sample**2).mean() for sample in samples]
    assert mean(squares).agrees(0.5), mean(squares)
    middles = [sample.mean() for sample in samples]
    assert mean(middles).agrees(0.0), mean(middles)
    held = 0.5 * trap.k * (samples[-1] ** 2).sum()
    assert 0 < fluid.solutes.potential_energy() - held < 20  # and that of the dimer


def test_observables_see_trapped_dimers_as_boltzmann_has_them():
    """One bead held across an edge of the box, the other pulled: normal, folded into the box."""
    held = {"traps": [Trap([6.0, 11.5], k=2.0, bead=1)], "pulls": [Pull([0.0, 0.6], bead=2)]}
    fluid = in_random_solvent(Polymer(40, length=2), **held)
    seen = {
        "beads": DensityProfile(of="beads", bins_per_cell=2),
        "ends": DensityProfile(of="ends", bins_per_cell=2),
        "centres": DensityProfile(of="centres", bins_per_cell=2),
        "histogram": MoleculeHistogram(of="centre", axis="y"),
        "moved": MeanSquareDisplacement(of="beads", every=300, max_lag=9000, components=["y"]),
    }
    found = {name: one.accumulator(fluid.case) for name, one in seen.items()}
    short = dataclasses.replace(seen["moved"], max_lag=900).accumulator(fluid.case)
    fluid.advance(2000)
    for _ in range(60):
        fluid.advance(300)
        for one in (*found.values(), short):
            one.observe(fluid)
    shape = theory.trapped_shape([(0, 1)], 2.0, [2.0, 0.0], [[11.5], [0.0]], [[0.0], [0.6]])
    assert shape.mean[:, 0].tolist() == pytest.approx([11.8, 12.1])
    assert np.diag(shape.covariance).tolist() == pytest.approx([0.5, 1.0])
    assert shape.centre_variance == pytest.approx(0.625)
    for name, one in found.items():
        result = one.result()
        for c in comparisons(result):
            assert abs(c.measured - c.expected) < 4 * c.error, (name, c)
    spread = found["histogram"].result()["mean square distance"]
    assert spread.expected == pytest.approx(0.625, rel=0.01) and spread.error < 0.05
    level = found["moved"].result()["mean square displacement"]
    assert level.expected == pytest.approx(2 * 0.75) and level.error < 0.15
    # lags that are too short say so, and no theory is drawn
    assert short.result().expected is None
    assert "the longest here is 900" in short.result()["mean square displacement"].note


def test_a_pulled_chain_is_stretched_by_the_sum_of_its_springs():
    """Each spring U = K r^2 carries the force f: f/(2 K), exactly."""
    force, stiffness, length = 1.2, 0.8, 3
    pulls = [Pull([-force, 0], bead=1), Pull([force, 0], bead=-1)]
    chains = Polymer(200, length=length)
    fluid = in_random_solvent(chains, size=(60, 60), K=stiffness, pulls=pulls)
    fluid.advance(1000)
    samples = []
    for _ in range(14):
        fluid.advance(900)  # four of the longest times of the chains: hardly any memory
        r = places(fluid, 200 * length).reshape(-1, length, 2)
        samples.append((r[:, -1] - r[:, 0]).mean(axis=0))
    found = mean(np.array(samples)[:, 0])
    expected = (length - 1) * force / (2 * stiffness)
    assert found.agrees(expected), (found, expected)
    assert mean(np.array(samples)[:, 1]).agrees(0.0)


@pytest.mark.parametrize(
    ("pulls", "warned"),
    [
        ([Pull([0.0, 1], bead=1)], "along y, and"),
        ([Pull([0.1, 0.3], bead=1), Pull([-0.1, -0.3], bead=-1)], ""),
        ([Pull([-0.1, 1]), Pull([0.3, 0], bead=2)], "along y, and"),  # on each of three beads
    ],
)
def test_forces_that_nothing_balances_are_warned_of(pulls, warned):
    solutes = Solutes((Polymer(2, length=3),), bond=Harmonic(K=1), pulls=pulls)
    case = Case(run=Run(steps=1), box=Box([8, 8]), fluid=Fluid(), solutes=solutes)
    found = [text for text in derive(case).warnings if text.startswith("solutes.pulls")]
    assert len(found) == bool(warned) and all(warned in text for text in found)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"pulls": [Pull([1.0, 0, 0])]}, "expected 2 numbers"),
        ({"pulls": [Pull([1.0, 0], bead=4)]}, r"bead = 4: expected 1 to 3"),
        ({"traps": [Trap([1.0, 0], kind=2)]}, "kind = 2"),
        ({"magnetic": [MagneticField([1.0, 0, 0])]}, r"expected \[0, 0, B\]"),
        ({"traps": [Trap([1.0, 0], k=1e6)], "substeps": 2}, "unstable"),
        (
            {"traps": [Trap([1.0, 9])]},
            r"centre = \[1, 9\]: outside the box along y",
        ),
    ],
)
def test_what_does_not_fit_is_refused(parts, words):
    solutes = Solutes((Polymer(1, length=3),), bond=Harmonic(K=1), **parts)
    with pytest.raises(CaseError, match=words):
        Case(run=Run(steps=1), box=Box([8, 8]), fluid=Fluid(), solutes=solutes)
