"""How bodies are arranged and directed, and the flow around them: given ones, without an engine."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    BodyFlow,
    BodyOrder,
    BodyProfile,
    CaseError,
    Plates,
    RadialDistribution,
    StructureFactor,
    theory,
)
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.protocol import BodyStart, Squirming
from mesokit.method.mpcd.body.sphere import SphereBody
from mesokit.method.mpcd.expected.bodies import followed
from mesokit.method.mpcd.expected.body_heights import heights
from mesokit.method.mpcd.fluid import Fluid
from mesokit.report.figures import plot
from tests.helpers.moving_disks import with_a_plank
from tests.helpers.whole_fluid import AtOnce

MANY = DiskBody(radius=1, number=36, name="many")


def case_of(*bodies, size=(30, 30), observe=(), walls=()):
    """Bodies in a thin fluid, at rest but for what moves them."""
    return Case(
        run=Run(10), box=Box(size), fluid=Fluid(density=5), bodies=bodies, walls=walls,
        observe=observe,
    )  # fmt: skip


class Placed(AtOnce):
    """Bodies at given places in given directions, and a fluid of a given velocity around them."""

    def __init__(self, case, places, headings=None, flow=None, seed=1, at=0.0):
        self.case, self.box, self.bodies = case, np.array(case.box.size, float), self
        self.n, self.time, self.given = case.particles, at, np.asarray(places, float)
        self.headings = np.ones_like(self.given) if headings is None else np.asarray(headings)
        self.velocity, self.angles = np.zeros_like(self.given), np.zeros((len(places), 3))
        self.flow, self.rng = flow, np.random.default_rng(seed)
        self.where = self.rng.random((self.n if flow else 0, len(self.box))) * self.box

    def places(self):
        return self.given % self.box

    def positions(self, ids):
        ids = np.asarray(ids)
        return self.where[ids] if self.flow else self.places()[ids - self.n]

    def velocities_of_fluid(self, ids):
        away = self.positions(ids) - self.given[0]
        return self.flow(away - self.box * np.round(away / self.box), self.headings[0])

    def masses(self, ids):
        """1, but 0 in the first body."""
        away = self.positions(ids) - self.given[0]
        away -= self.box * np.round(away / self.box)
        radius = self.case.bodies[0].radius
        return 1.0 * ((away**2).sum(axis=1) > radius**2)

    def __getattr__(self, name):
        if name == "velocities":  # of bodies by themselves, of the fluid by numbers
            return _Velocities(self)
        raise AttributeError(name)


class _Velocities:
    def __init__(self, placed):
        self.placed = placed

    def __call__(self, ids):
        return self.placed.velocities_of_fluid(ids)

    def __getitem__(self, rows):
        return self.placed.velocity[rows]


def seen(case, observable, samples):
    """The result of so many states."""
    accumulator = observable.accumulator(case)
    for sample in samples:
        accumulator.observe(sample)
    return accumulator.result()


def drawn(case, samples, number=36):
    """Bodies at independent places, in independent directions."""
    rng = np.random.default_rng(4)
    for _ in range(samples):
        angle = rng.uniform(0, 2 * np.pi, number)
        headings = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        yield Placed(case, rng.random((number, 2)) * 30, headings)


def test_bodies_at_independent_places_have_neither_neighbours_nor_structure():
    case = case_of(MANY)
    g = seen(case, RadialDistribution(of="bodies", bins=10), drawn(case, 100))
    assert g.expected is None and g.x["r"][-1] == 9.5  # five of their diameters
    assert (abs(g.value - 1) < 4 * g.error).all() and (g.error < 0.2).all()
    near = g["neighbours"]
    assert abs(near.measured - 35 * np.pi * 100 / 900) < 4 * near.error < 1
    s = seen(case, StructureFactor(of="bodies", largest=2), drawn(case, 100))
    assert (abs(s.value - 1) < 4.5 * s.error).all() and s.expected is None


def test_bodies_on_a_lattice_scatter_in_the_directions_of_bragg():
    case = case_of(MANY)
    rows = 5.0 * np.stack(np.meshgrid(np.arange(6), np.arange(6)), axis=-1).reshape(-1, 2)
    s = seen(case, StructureFactor(of="bodies", kind="many", largest=1.3), [Placed(case, rows)])
    assert s.value[-2:].max() == pytest.approx(36 / 2, rel=0.6)  # a share of the shell of 2 pi/5
    assert s.value[:-2].max() < 1e-20
    g = seen(case, RadialDistribution(of="bodies", reach=6, bins=6), [Placed(case, rows)])
    assert np.flatnonzero(g.value).tolist() == [4]  # (4, 5], where there are four


def test_pairs_of_two_kinds():
    case = with_a_plank()
    here = Placed(case, [[2, 2], [6, 2], [2, 6], [4, 4]])
    g = seen(case, RadialDistribution(of="bodies", kinds=("disks", "planks"), bins=7), [here])
    assert np.flatnonzero(g.value).tolist() == [2]  # 8^(1/2)
    assert g["neighbours"].measured == pytest.approx(1)
    with pytest.raises(CaseError, match=r"kinds = \['rods'\]: expected 'disks', 'planks', 1 or 2"):
        with_a_plank(observe=[RadialDistribution(of="bodies", kinds=("rods",))])
    with pytest.raises(CaseError, match="needs bodies that move in the fluid"):
        case_of(observe=[StructureFactor(of="bodies")])


def test_order_of_given_directions():
    case = case_of(MANY)
    line = np.tile([0.6, 0.8], (36, 1))
    result = seen(case, BodyOrder(), [Placed(case, line, line)])
    np.testing.assert_allclose(result.value, [[1, 1]])
    np.testing.assert_allclose(result.extra["heading"], [[0.6, 0.8]])
    line[::2] *= -1
    result = seen(case, BodyOrder(), [Placed(case, line, line, at=t) for t in (0.0, 1.0)])
    np.testing.assert_allclose(result.value, [[0, 1]] * 2, atol=1e-12)
    assert "independent directions; error bar is a lower bound" in result.comparisons[-1].note
    assert len(plot(result).axes) == 2


def test_independent_directions_have_an_order_of_one_over_the_root_of_their_number():
    case = case_of(MANY)
    result = seen(case, BodyOrder(kind="many"), drawn(case, 300))
    for name in ("polar", "nematic"):
        found = result[f"mean square {name} order"]
        assert found.expected == pytest.approx(1 / 36)
        assert abs(found.measured - found.expected) < 4 * found.error < 0.01
    pushed = case_of(DiskBody(radius=1, number=36, torque=1.0))
    assert np.isnan(seen(pushed, BodyOrder(), drawn(pushed, 4))["mean square polar"].expected)


def between_plates(force=-3.0):
    [walls] = [[Plates(axis="y")]]
    sinking = DiskBody(radius=1.5, number=1, force=(0.0, force))
    return case_of(sinking, size=(12, 16), walls=walls)


def test_a_body_between_plates_is_spread_by_the_barometric_law():
    case = between_plates(-0.5)
    edges = np.arange(17.0)
    known = heights(followed(case, "this"), 1, edges)
    middle = known.shares[3:13]  # without the plates' repulsion
    np.testing.assert_allclose(middle[1:] / middle[:-1], np.exp(-0.5), rtol=1e-4)
    assert known.shares.sum() == pytest.approx(1) and known.shares[0] == known.shares[-1] == 0
    assert "warm" in known.note  # SRD without a thermostat
    assert heights(followed(between_plates(0.0), "this"), 1, edges).mean == pytest.approx(8)
    assert heights(followed(case_of(MANY), "this"), 1, edges) is None


def test_profile_of_given_bodies():
    case = between_plates()
    up, tilted = Placed(case, [[3, 4.2]], [[0.0, 1.0]]), Placed(case, [[3, 8.9]], [[0.6, -0.8]])
    result = seen(case, BodyProfile(axis="y"), [up, tilted, up])
    assert result.x["of"].tolist() == ["density", "heading x", "heading y", "nematic"]
    np.testing.assert_allclose(result.value[4], [2 / 3 / 12, 0, 1, 1], atol=1e-12)
    np.testing.assert_allclose(result.value[8], [1 / 3 / 12, 0.6, -0.8, 2 * 0.64 - 1])
    assert np.isnan(result.value[5, 1:]).all() and result.value[5, 0] == 0
    place = result["mean place along y"]
    assert place.measured == pytest.approx((2 * 4.2 + 8.9) / 3) and place.expected < 4
    assert result["nematic order about y"].expected == 0  # any direction is alike
    assert plot(result).axes[0].get_ylabel().startswith("density")


SWIM = Squirming(B1=0.3, B2=-0.2)
FIRST = BodyStart(rule="given", positions=((1.0, 2.0),))


def around(case, radius, samples, *box):
    """A squirmer that goes across an edge of the box and turns, with the flow of theory."""

    def flow(away, heading):
        return theory.squirmer_flow(away, heading, radius, SWIM.B1, SWIM.B2, *box)

    d = case.box.dimension
    for k in range(samples):
        heading = np.array([np.cos(k), np.sin(k), 0.0])[:d]
        if d == 3:
            heading = np.array([np.cos(k) * 0.8, np.sin(k) * 0.8, 0.6])
        yield Placed(case, [[0.3 * k - 1.0] * d], [heading], flow, seed=k)


@pytest.mark.parametrize(("d", "longer"), [(2, 0), (2, 1), (3, 1)])
def test_the_flow_around_a_body_is_that_in_its_own_frame(d, longer):
    """With slip and images in a square; in a longer box theory is that without bounds."""
    kind = DiskBody if d == 2 else SphereBody
    case = case_of(kind(radius=2, swim=SWIM), size=(14 + longer, *(14,) * (d - 1)))
    of = followed(case, "body-flow", 1)
    box = () if longer else (of.slip[0] / 2, 14.0**2, of.asymmetric_share)
    flows = around(case, 2.0, 30 if d == 2 else 12, *box)
    result = seen(case, BodyFlow(reach=7), flows)
    note = result["flow over theory"].note
    assert ("bounds" if longer else "inertia, whose Re is 0.52") in note and "approximate" in note
    assert result.value.shape == ((14, 14, 2) if d == 2 else (14, 7, 3))
    assert result["flow over theory"].measured == pytest.approx(1, abs=0.02)
    known = np.isfinite(result.expected) & np.isfinite(result.value)
    off = (result.value - result.expected)[known]
    assert known.sum() > 250 and np.sqrt((off**2).mean()) < 0.01
    assert abs(off).max() < 0.1 < 0.15 < abs(result.expected[known]).max()


def test_the_figure_of_a_flow_has_theory_beside():
    case = case_of(SphereBody(radius=2, swim=SWIM), size=(14,) * 3)
    result = seen(case, BodyFlow(bins_per_cell=2), around(case, 2.0, samples=1))
    assert len(plot(result).axes) == 4  # two maps, a line, a bar


def test_a_solid_rotation_of_the_fluid_turns_with_a_body():
    case = case_of(MANY.__class__(radius=2), size=(16, 16))
    rate = 0.5

    def flow(away, heading):
        return rate * np.stack([-away[:, 1], away[:, 0]], axis=1)

    def states():
        for k in range(30):
            yield Placed(case, [[15.0, 1.0]], [[np.cos(k), np.sin(k)]], flow, seed=k)

    result = seen(case, BodyFlow(reach=5), states())
    along, across = np.meshgrid(result.x["along"], result.x["across"], indexing="ij")
    # particles fill a bin at random: the mean of 150 of them
    noise = 5 * rate / np.sqrt(12 * 100)
    out = np.hypot(along, across) > 3
    np.testing.assert_allclose(result.value[out, 0], -rate * across[out], atol=noise)
    np.testing.assert_allclose(result.value[out, 1], rate * along[out], atol=noise)
    assert result.expected is None and len(plot(result).axes) == 3
    with pytest.raises(CaseError, match="reach = 9: expected at most 8"):
        case_of(DiskBody(radius=2), size=(16, 16), observe=[BodyFlow(reach=9)])
