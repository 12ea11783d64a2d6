"""Two species that demix: the weight of rotations, when they do, and one tension by two routes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import njit
from scipy.special import ive

from mesokit import CaseError, Demix, DomainSize, Species, theory
from mesokit.method.mpcd.collision.directed import quaternion, turned_by, von_mises
from mesokit.method.mpcd.engine.cell_gradient import NeighbourSums, gradient_at
from tests.helpers.small_fluids import Measured, make_fluid, mean

DENSITY = 10
TWO = (Species(mass=1, density=5), Species(mass=1, density=5))
TENSION = 0.05  # the coupling at which the tension is measured


@njit
def cosines(chance, k):
    """Cosines, in the plane and in space, of the angle to the direction that is favoured."""
    found = np.empty((2, len(chance)))
    for i in range(len(chance)):
        words = chance[i, 0], chance[i, 1]
        found[0, i] = von_mises(words, k)[1]
        a, b = (0.6, 0.0, 0.8), (0.0, 1.0, 0.0)
        found[1, i] = turned_by(quaternion(words, k, a, b), a)[1]
    return found


@pytest.mark.parametrize("k", [0.0, 0.3, 3.0, 30.0])
def test_rotations_have_the_weight_of_their_angle(k):
    """exp(k cos): I1/I0 in the plane, Langevin's function in space."""
    chance = np.random.default_rng(1).integers(0, 2**32, (40_000, 2), dtype=np.uint64)
    plane, space = cosines(chance, k)
    assert mean(plane).agrees(ive(1, k) / ive(0, k)), mean(plane)
    assert mean(space).agrees(1 / math.tanh(k) - 1 / k if k else 0.0), mean(space)
    second = ive(2, k) / ive(0, k)  # of twice the angle
    assert mean(2 * plane**2 - 1).agrees(second), mean(2 * plane**2 - 1)


@pytest.mark.parametrize("cells", [(5, 6), (5, 6, 4)], ids=["2D", "3D"])
def test_gradient_of_a_line_is_its_slope(cells):
    """In the middle; round the box, or as if the last cell came once more where walls are."""
    slope = (2.0, -3.0, 0.5)[: len(cells)]
    place = np.stack(np.meshgrid(*map(np.arange, cells), indexing="ij"), -1).astype(float)
    values = np.ascontiguousarray((place @ slope).transpose()).ravel()  # x varies fastest
    ask = njit(lambda field, cell: gradient_at(field, cell))
    strides = np.cumprod((1, *cells[:-1]))
    inside = int(np.dot([2] * len(cells), strides))
    corner = int(np.dot(np.array(cells) - 1, strides))
    periodic = NeighbourSums(0, values, cells, (0,) * len(cells))
    closed = NeighbourSums(0, values, cells, (1,) * len(cells))
    assert ask(periodic, inside) == pytest.approx(slope)
    assert ask(closed, corner) == pytest.approx([s / 2 for s in slope])
    # the next cell is the first, further away by all cells
    around = [s - s * n / 2 for s, n in zip(slope, cells, strict=True)]
    assert ask(periodic, corner) == pytest.approx(around)


def colour_mode(fluid, k):
    charge = np.where(fluid.species() == 0, 1.0, -1.0)
    return (charge * np.cos(k * fluid.positions()[:, 0])).sum()


def spreading(coupling):
    """Diffusion coefficient of a wave of colour, from how it fades."""
    side, width, time, found = 20, 160, 10.0, []
    k, n = 2 * math.pi / side, DENSITY * side * width // 2
    for seed in range(1, 5):
        # quantiles of 1 +- 0.3 cos(kx): no noise but that of the motion
        x = np.linspace(0, side, 4001)
        places = np.random.default_rng(seed).uniform(0, width, (2 * n, 2))
        for kind, amplitude in enumerate((0.3, -0.3)):
            share = (x + amplitude * np.sin(k * x) / k) / side
            places[kind * n : (kind + 1) * n, 0] = np.interp((np.arange(n) + 0.5) / n, share, x)
        parts = {"species": TWO, "collision": Demix(coupling), "seed": seed}
        fluid = make_fluid((side, width), places, **parts)
        fluid.advance(20)  # until the flux has grown to its steady value
        first = colour_mode(fluid, k)
        fluid.advance(round(time / 0.1))
        found.append(math.log(first / colour_mode(fluid, k)) / (k * k * time))
    return mean(found)


def test_waves_of_colour_fade_below_the_threshold_and_grow_above():
    """By density times the coupling slower; vortices add to D of molecular chaos in 2D."""
    free, limit = spreading(0.0), theory.demixing_coupling(2, DENSITY, 0.1)
    chaos = theory.demixing_diffusion(2, DENSITY, 0.1, 0.0)
    assert -3.5 * free.error < free.value - chaos < 0.5 * chaos, free
    for coupling in (0.9 * limit, 2 * limit):
        slowed = spreading(coupling)
        fall = Measured(free.value - slowed.value, math.hypot(free.error, slowed.error))
        expected = chaos - theory.demixing_diffusion(2, DENSITY, 0.1, coupling)
        # a wave of 20 cells: gradients of neighbours and places in a cell lose some 5 %
        assert fall.agrees(expected, systematic=0.05), fall
        assert slowed.value * (limit - coupling) > 3 * slowed.error * abs(limit - coupling), slowed


def film_tension(size=(30, 20), samples=20, start=1000):
    """By the stress: what pulls along the interfaces of a film more than across."""
    width, d = size[0], len(size)
    n = DENSITY * math.prod(size) // 2
    places = np.random.default_rng(1).uniform(0, 1, (2 * n, d)) * (width / 2, *size[1:])
    places[n:, 0] += width / 2
    parts = {"species": TWO, "collision": Demix(TENSION), "measures": ("stress",)}
    fluid = make_fluid(size, places, **parts)
    fluid.advance(start)
    found = []
    for _ in range(samples):
        total = np.zeros((d, d))
        for _ in range(300):
            fluid.advance(1, measure=["stress"])
            total += sum(fluid.stress.values()) / 300
        found.append((np.diag(total)[1:].mean() - total[0, 0]) * width / 2)
    return mean(found)


def droplet_tension(d=2, side=32, radius=8.0, apart=3.0, samples=20, start=1000):
    """By Laplace's law: R/(d - 1) times what the ideal gas in a droplet has more of pressure."""
    ball = math.pi if d == 2 else 4 / 3 * math.pi
    inside, all_of = round(DENSITY * ball * radius**d), DENSITY * side**d
    kinds = tuple(Species(mass=1, density=number / side**d) for number in (inside, all_of - inside))
    places = np.random.default_rng(2).uniform(0, side, (4 * all_of, d))
    far = np.linalg.norm(places - side / 2, axis=1)
    outside = all_of - inside
    places = np.concatenate([places[far < radius][:inside], places[far > radius][:outside]])
    parts = {"species": kinds, "collision": Demix(TENSION), "measures": ("stress",)}
    fluid = make_fluid((side,) * d, places, **parts)
    first = fluid.species() == 0
    fluid.advance(start)
    found = []
    for _ in range(samples):
        jump = []
        for _ in range(40):
            fluid.advance(10 if d == 2 else 5)
            r = fluid.positions()
            centre = np.angle(np.exp(2j * math.pi * r[first] / side).sum(axis=0))
            way = (r - centre * side / (2 * math.pi) + side / 2) % side - side / 2
            far = np.linalg.norm(way, axis=1)
            core, rest = radius - apart, radius + apart
            inner = (far < core).sum() / (ball * core**d)
            jump.append(inner - (far > rest).sum() / (side**d - ball * rest**d))
        found.append(np.mean(jump) * radius / (d - 1))
    return mean(found)


@pytest.mark.long
def test_in_space_too_film_and_droplet_have_one_tension():
    """4.0(1) kT/a^2 across a film. The droplet's radius of five cells is known to half a cell."""
    film = film_tension((16, 8, 8), samples=8, start=200)
    droplet = droplet_tension(3, side=16, radius=5.0, apart=2.5, samples=6, start=200)
    assert film.value > 20 * film.error, film
    assert droplet.value > 6 * droplet.error, droplet
    both = Measured(film.value - droplet.value, math.hypot(film.error, droplet.error))
    assert abs(both.value) < 3.5 * both.error + film.value / 10, (film, droplet)


def test_domains_of_a_mixture_grow_to_the_size_of_the_box():
    """A band with sharp edges: odd waves n, of power 1/n^2, of which the longest three count."""
    side, n = 20, np.array([1, 3, 5])
    fluid = make_fluid((side, side), species=TWO, collision=Demix(TENSION), measures=("stress",))
    seen = DomainSize().accumulator(fluid.case)
    for steps in (0, 50, 400, 4500):
        fluid.advance(steps)
        seen.observe(fluid)
    mixed, early, later, last = seen.result().value
    assert np.isnan(mixed) and 1.4 * early < later < last / 1.4, (mixed, early, later, last)
    # edges that are not sharp make it larger, those of a drop smaller
    assert last == pytest.approx(side * (1 / n**2).sum() / (1 / n).sum(), rel=0.12)


def test_stress_across_a_film_and_pressure_in_a_droplet_are_one_tension():
    film, droplet = film_tension(), droplet_tension()
    assert film.value > 6 * film.error, film
    assert droplet.value > 4 * droplet.error, droplet
    both = Measured(film.value - droplet.value, math.hypot(film.error, droplet.error))
    # the radius is known to half a cell only: the interface is some two cells wide
    assert abs(both.value) < 3.5 * both.error + film.value / 16, (film, droplet)


def test_what_has_no_physics_is_refused():
    three = (*TWO, Species(mass=1, density=1))
    for species in ((), three):
        words = rf"fluid\.species: {len(species)} of them; .*'demix' needs 2"
        with pytest.raises(CaseError, match=words):
            make_fluid((8, 8), species=species, collision=Demix())
    with pytest.raises(CaseError, match=r"box\.shear_rate = 0\.1: not with .*'demix'"):
        make_fluid((8, 8), species=TWO, collision=Demix(), shear_rate=0.1)
