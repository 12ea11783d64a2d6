"""Rigid grains in sheared boxes (Lees and Edwards 1972)."""

import numpy as np
import pytest

from mesokit import RandomStart, SphereKind
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from tests.helpers.rigid_grains import at_rest, exact, impulses, rigid

RATE, HEIGHT, WIDTH = 0.3, 8.0, 12.0
ROUGH = {"friction": 0.3, "restitution": 0.5}


def box_of(dimension):
    return [WIDTH, HEIGHT] if dimension == 2 else [WIDTH, HEIGHT, 6.0]


def padded(rows, dimension):
    return np.pad(np.array(rows, float), ((0, 0), (0, dimension - 2)))


def sheared(places, velocities, dimension=2, rate=RATE, **given):
    places = padded(places, dimension) + [0.0, 0.0, 3.0][:dimension]
    return rigid(
        box_of(dimension), given=at_rest(places, velocities=padded(velocities, dimension)),
        box={"shear_rate": rate} if rate else {}, timestep=0.01, contact=ROUGH, solver=exact(),
        **given,
    )  # fmt: skip


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.long)])
@pytest.mark.parametrize("up", [1.0, -1.0])
def test_what_crosses_the_box_goes_on_with_the_speed_of_its_image(dimension, up):
    # x and v_x change by those of the image; one of the two comes to y = 0 but for rounding
    start = [[3.0, 4.0 + 3.5 * up]]
    engine = sheared(start, [[0.4, up]], dimension)
    engine.advance(200)
    t = engine.time
    assert engine.velocities()[0, 0] == pytest.approx(0.4 - up * RATE * HEIGHT, abs=1e-12)
    x = 3.0 + 0.4 * t - up * RATE * HEIGHT * t
    assert engine.positions()[0, 0] == pytest.approx(x % WIDTH, abs=1e-9)
    y = 4.0 + 3.5 * up + up * t - up * HEIGHT
    assert engine.positions()[0, 1] == pytest.approx(y, abs=1e-9)
    assert engine.images()[0, 1] == up


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.long)])
def test_a_collision_across_the_boundary_is_one_with_the_image(dimension):
    """The same as in a box at rest, with the speed of the image given to one of the two."""
    speed, steps = RATE * HEIGHT, 30
    low, high = [6.0, 0.4], [6.0, HEIGHT - 0.7]  # the image of the low one is 0.1 above the high
    found = []
    for rate in (RATE, 0.0):
        places, velocities = [low, high], [[0.1, -0.5], [0.2, 0.6]]
        if not rate:
            places[0] = [low[0], 4.4]
            places[1] = [high[0], high[1] - HEIGHT + 4.0]
            velocities[0] = [0.1 + speed, -0.5]
        engine = sheared(places, velocities, dimension, rate)
        engine.advance(steps)
        v = engine.velocities()
        # what has crossed has the speed of the other image
        gone = engine.images()[:, 1]
        v[:, 0] += speed * gone if rate else 0.0
        v[0, 0] -= 0.0 if rate else speed
        found.append((v, engine.spins().copy(), dict(engine.lost)))
    assert found[0][0] == pytest.approx(found[1][0], abs=1e-9)
    assert found[0][1] == pytest.approx(found[1][1], abs=1e-9)
    assert found[0][2] == pytest.approx(found[1][2], abs=1e-9)
    assert np.abs(found[0][1]).max() > 0.1
    assert found[0][2]["impact"] > 0.01


def work_and_stress(engine, steps, every=5):
    """Stress xy of contacts and of momentum; what contacts take, per time and area."""
    area, total, count = float(np.prod(engine.box)), 0.0, 0
    before = sum(engine.lost.values())
    began = engine.time
    for _ in range(steps // every):
        engine.advance(every)
        offset = RATE * HEIGHT * (engine.time - engine.timestep)
        r = engine.positions() - engine.timestep * engine.velocities()
        pairs, found = impulses(engine)
        apart = r[pairs[:, 0]] - r[pairs[:, 1]]
        over = np.rint(apart[:, 1] / HEIGHT)
        apart[:, 1] -= HEIGHT * over
        apart[:, 0] -= offset * over
        apart[:, 0] -= WIDTH * np.rint(apart[:, 0] / WIDTH)
        v = engine.velocities()
        own = v[:, 0] - RATE * (engine.positions()[:, 1] - 0.5 * HEIGHT)
        total += (found[:, 0] * apart[:, 1]).sum() / engine.timestep
        total += engine.masses() @ (own * v[:, 1])
        count += 1
    taken = (sum(engine.lost.values()) - before) / (engine.time - began)
    return -total / count / area, taken / area


def test_the_work_of_shear_is_what_contacts_take():
    # in a steady flow stress times shear rate is the energy lost, per time and area
    engine = rigid(
        [WIDTH, HEIGHT], number=90, kinds=[SphereKind(1.0, spread=0.2, mass=1.0)],
        start=RandomStart(), box={"shear_rate": RATE}, timestep=0.01, contact=ROUGH,
        solver=GaussSeidel(sweeps=60), push_back=0.05,
    )  # fmt: skip
    engine.advance(1500)
    parts = np.array([work_and_stress(engine, 500) for _ in range(16)])
    stress, taken = parts.mean(axis=0)
    error = (RATE * parts[:, 0] - parts[:, 1]).std(ddof=1) / np.sqrt(len(parts))
    assert error < 0.05 * taken
    assert abs(RATE * stress - taken) < 4 * error
    assert stress > 0.05
    # the mean flow is that of the images
    v, y = engine.velocities()[:, 0], engine.positions()[:, 1]
    assert np.polyfit(y, v, 1)[0] == pytest.approx(RATE, rel=0.3)
