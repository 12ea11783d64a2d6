"""Observables of grains: packings, flows, heaps, columns and silos whose numbers are known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from mesokit import (
    Box,
    EnergyBudget,
    Outflow,
    PackingFraction,
    Plates,
    ReposeAngle,
    RunOut,
    ShearRheology,
    SphereKind,
    Surface,
    WallLoad,
    theory,
)
from mesokit.method.spheres.common.observe.shared.cut_volumes import in_slabs, whole
from tests.helpers.comparisons import by_name, comparison
from tests.helpers.fake_spheres import FakeSpheres, hard

FALL = {"gravity": (0, -1), "walls": [Plates("y")], "packing_fraction": None}
CLOSED = {**FALL, "walls": [Plates("x"), Plates("y")]}


class Placed(FakeSpheres):
    """Spheres where a function of time says, with what walls have taken and energies by another."""

    def __init__(self, case, path, taken=None):
        self.path, self.taken = path, taken
        super().__init__(case)

    def advance(self, steps):
        self.step += steps
        self.r = np.asarray(self.path(self.time), float)
        self.v = np.zeros_like(self.r)
        if self.taken is not None:
            self.wall_impulse = np.asarray(self.taken, float) * self.time

    def positions(self, ids=None, unwrapped=False):
        places = self.r if unwrapped else self.r % self.box
        return places if ids is None else places[ids]


def after(observable, case, spheres, samples=20, steps=1):
    """The result of samples after so many steps each, the first at once."""
    accumulator = observable.accumulator(case)
    for k in range(samples):
        spheres.advance(steps if k else 0)
        accumulator.observe(spheres)
    return accumulator.result()


# --- packing fraction -----------------------------------------------------------------------------


@pytest.mark.parametrize("size", [(12, 9), (9, 8, 7)])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_slabs_of_a_periodic_box_hold_all_spheres_exactly(size, axis):
    observable = PackingFraction(axis=axis, bins=7)
    kinds = [SphereKind(1.0, spread=0.4), SphereKind(1.7)]
    case = hard([observable], size=size, number=30, kinds=kinds, packing_fraction=None)
    spheres = FakeSpheres(case)
    result = after(observable, case, spheres, samples=4)
    known = whole(0.5 * spheres.diameters(), len(size)).sum() / case.box.volume
    assert result["packing fraction of the box"].measured == pytest.approx(known, rel=1e-12)
    assert result.value.mean() == pytest.approx(known, rel=1e-12)
    assert np.ptp(result.value) > 0.01 * known


def test_a_region_that_cuts_disks_through_their_centres_holds_the_fraction_of_the_lattice():
    observable = PackingFraction(region=[[0.5, 4.5], [1.5, 3.5]], axis="x", bins=4)
    case = hard([observable], size=(6, 6), number=36, packing_fraction=None)
    rows = np.stack(np.meshgrid(np.arange(6), np.arange(6)), -1).reshape(-1, 2) + 0.5
    result = after(observable, case, Placed(case, lambda time: rows), samples=1)
    np.testing.assert_allclose(result.value, math.pi / 4, rtol=1e-12)


def test_parts_of_a_sphere_about_a_corner_add_up():
    place, radius = np.array([[1.1, 0.9, 1.2]]), np.array([0.5])
    cut, parts = [(0.0, 1.0), (1.0, 2.0)], []
    for x in cut:
        for y in cut:
            region = np.array([x, y, (0.0, 2.0)])
            parts += list(in_slabs(place, radius, region, 2, np.array([0.0, 1.0, 2.0])))
    assert sum(parts) == pytest.approx(float(whole(radius, 3)[0]), rel=2e-4)
    assert min(parts) > 0.001


def test_the_interior_of_a_bed_is_as_dense_as_its_lattice():
    observable = PackingFraction(interior=True)
    case = hard([observable], size=(10, 20), number=100, **FALL)
    rows = np.stack(np.meshgrid(np.arange(10), np.arange(10)), -1).reshape(-1, 2) + 0.5
    result = after(observable, case, Placed(case, lambda time: rows), samples=1)
    found = by_name(result)
    assert found["packing fraction of the box"].measured == pytest.approx(math.pi / 8, rel=1e-12)
    interior = found["packing fraction of the interior"].measured
    assert interior == pytest.approx(math.pi / 4, rel=0.02)  # it ends within rows


# --- outflow --------------------------------------------------------------------------------------


def stream(case, speed, size=(9, 9)):
    start = np.random.default_rng(3).random((case.particles, 2)) * size
    return Placed(case, lambda time: start + np.array([speed, 0.3 * speed]) * time)


@pytest.mark.parametrize("speed", [0.45, -0.45])
def test_a_stream_passes_at_its_speed_over_the_length_of_the_box(speed):
    observable = Outflow(axis="x", at=2.0)
    case = hard([observable], number=60, packing_fraction=None, kinds=[SphereKind(0.5, mass=3.0)])
    found = by_name(after(observable, case, stream(case, speed), samples=201))  # ten boxes
    rate = 60 * speed / 9
    assert found["mean rate of grains"].measured == pytest.approx(rate, rel=1e-12)
    assert found["mean rate of mass"].measured == pytest.approx(3 * rate, rel=1e-12)
    area = math.pi / 16
    assert found["mean rate of volume"].measured == pytest.approx(area * rate, rel=1e-12)
    assert found["grains that passed"].measured == np.sign(speed) * 600


def test_what_passes_beside_the_window_is_left_out():
    open_, half = Outflow(axis="x"), Outflow(axis="x", window=[[0, 3]], name="half")
    case = hard([open_, half], number=400, size=(9, 9), packing_fraction=0.1)
    whole_, part = (after(one, case, stream(case, 0.45), samples=201) for one in (open_, half))
    passed = [result["grains that passed"].measured for result in (whole_, part)]
    assert passed[0] == 4000
    assert abs(passed[1] - 4000 / 3) < 4 * math.sqrt(400 * 2 / 9) * 10  # 400 lines of ten


def test_grains_that_come_back_count_against_those_that_go():
    observable = Outflow(axis="y", at=5.0)
    case = hard([observable], number=1, size=(9, 9), **FALL)
    path = [4.0, 6.0, 4.0, 6.0, 4.0, 3.0]
    spheres = Placed(case, lambda time: np.array([[4.5, path[int(time)]]]))
    result = after(observable, case, spheres, samples=6)
    assert result["grains that passed"].measured == 0
    spheres = Placed(case, lambda time: np.array([[4.5, path[::-1][int(time)]]]))
    # from 3 to 4 and up and down: the last of six places is below, so is the first
    assert after(observable, case, spheres, samples=3)["grains that passed"].measured == -1


def test_a_silo_has_the_law_of_beverloo_beside_its_rate():
    observable = Outflow(axis="y", at=4.5, width=6.0, fraction=0.7, of="mass")
    case = hard([observable], number=200, size=(9, 9), kinds=[SphereKind(0.2)], **FALL)
    start = np.random.default_rng(4).random((200, 2)) * [9, 4] + [0, 4.6]
    fall = Placed(case, lambda time: start - [0.0, min(time, 60) * 0.1])
    result = after(observable, case, fall, samples=101)
    found = comparison(result, "while it flows")
    mass = case.spheres.kinds[0].mean_mass(2)
    density = 0.7 * mass / (math.pi * 0.01)
    known = float(theory.beverloo_rate(6.0, 0.2, density, 1.0, 2))
    assert found.expected == pytest.approx(known, rel=1e-9)
    assert result.expected[0] == found.expected
    assert found.measured == pytest.approx(200 * mass / 40, rel=0.05)  # 4 deep at 0.1


# --- heaps and columns ----------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [15.0, 30.0])
def test_a_heap_of_a_known_slope_has_its_angle(degrees):
    observable, slope = ReposeAngle(), math.tan(math.radians(degrees))
    columns = []
    for x in np.arange(0.5, 80):  # each filled from its top down
        top = 1 + slope * (40 - abs(x - 40))
        height = top - 0.5 - np.arange(int(top))
        columns.append(np.stack([np.full(len(height), x), height], 1))
    rows = np.concatenate(columns)
    case = hard([observable], number=len(rows), size=(80, 60), **FALL)
    result = after(observable, case, Placed(case, lambda time: rows), samples=8)
    found = result["angle at the end"]
    assert found.measured == pytest.approx(degrees, abs=0.01)
    assert result.units["value"] == "degrees" and found.error < 0.01


def test_a_cone_has_the_angle_of_its_four_sectors():
    observable, slope = ReposeAngle(), math.tan(math.radians(25.0))
    x, y = (each.ravel() for each in np.meshgrid(*2 * [np.arange(-19.75, 20, 0.5)]))
    height = 19 * slope + 0.5 - slope * np.hypot(x, y)
    use = height > 0.5
    rows = np.stack([x + 20, y + 20, height], 1)[use]
    fall = {**FALL, "gravity": (0, 0, -1), "walls": [Plates("z")]}
    case = hard([observable], number=len(rows), size=(40, 40, 20), **fall)
    result = after(observable, case, Placed(case, lambda time: rows), samples=4)
    assert result["angle at the end"].measured == pytest.approx(25.0, abs=1.0)


def column(case, width, height, at=0.5):
    rows = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).reshape(-1, 2)
    assert len(rows) == case.particles
    return rows * 1.0 + [at, 0.5]


@pytest.mark.parametrize(("sides", "shift", "length"), [
    ("lower", 0.5, 5.0), ("upper", 55.5, 5.0), ("both", 20.5, 2.5),
])  # fmt: skip
def test_a_column_has_its_length_its_height_and_the_law_of_its_aspect_ratio(sides, shift, length):
    observable = RunOut(sides=sides)
    case = hard([observable], number=50, size=(60, 30), **CLOSED)
    tall, low = column(case, 5, 10, shift), column(case, 25, 2, shift)
    if sides == "upper":
        low[:, 0] -= 20
    spheres = Placed(case, lambda time: tall if time < 5 else low)
    result = after(observable, case, spheres, samples=40)
    found = comparison(result, "run-out")
    assert result["aspect ratio"].measured == pytest.approx(10 / length)
    assert found.measured == pytest.approx(4.0)  # 5 to 25
    assert found.expected == pytest.approx(float(theory.run_out(10 / length)))
    assert result["last height"].measured == pytest.approx(2 / length)
    assert np.nanmax(result.expected) == pytest.approx(length * (1 + found.expected))


def test_a_grain_that_rolls_ahead_alone_is_not_the_front():
    observable = RunOut()
    case = hard([observable], number=50, size=(60, 30), **CLOSED)
    rows = column(case, 5, 10)
    rows[-1] = [40.0, 0.5]
    result = after(observable, case, Placed(case, lambda time: rows), samples=3)
    assert result.value[0].tolist() == [5.0, 10.0]
    assert not result["run-out"].note.startswith("not steady")


# --- silos, shear, energy -------------------------------------------------------------------------


@pytest.mark.parametrize("gravity", [-0.5, 0.5])
def test_a_floor_bears_its_share_of_the_weight(gravity):
    observable = WallLoad(friction=0.5, ratio=0.4, width=6.0)
    fall = {**CLOSED, "gravity": (0, gravity)}
    case = hard([observable], number=50, size=(9, 20), **fall)
    mass = 50 * case.spheres.kinds[0].mean_mass(2)
    taken = np.zeros((4, 2))
    taken[2 if gravity < 0 else 3, 1] = 0.7 * mass * gravity  # x below, x above, y below, y above
    rows = column(case, 5, 10)
    if gravity > 0:
        rows[:, 1] = 20 - rows[:, 1]
    result = after(observable, case, Placed(case, lambda time: rows, taken))
    found = comparison(result, "load on the floor")
    assert found.measured == pytest.approx(0.7, rel=1e-9)
    assert result["height of the filling"].measured == pytest.approx(10.0)
    length = theory.janssen_length(6.0, 0.5, 0.4, 2)
    assert found.expected == pytest.approx(float(theory.janssen_share(10.0, length)))
    assert result.value[10] == pytest.approx(0.7) and np.isnan(result.value[:10]).all()


NOTES = {
    "law": "Janssen, with a stress ratio of 0.4",
    "pressed": "press the filling",
    "still": "of one filling",
}


@pytest.mark.parametrize(
    ("given", "load", "swing", "walls", "said"),
    [
        ({}, 0.7, 0.1, "xy", []),
        ({"friction": 0.5, "ratio": 0.4}, 0.7, 0.1, "xy", ["law"]),
        ({}, 0.7, 0.0, "xy", ["still"]),
        ({}, 1.2, 0.1, "xy", ["pressed"]),
        ({}, 1.01, 0.1, "xy", []),  # more by chance
        ({}, 1 + 1e-9, 0.0, "xy", ["still"]),  # and by what a solver leaves
        ({}, 1.2, 0.1, "y", []),  # there are no sides
        ({"friction": 0.5, "ratio": 0.4}, 1.2, 0.0, "xy", ["law", "pressed", "still"]),
    ],
)
def test_a_load_has_the_caveats_that_hold_of_it(given, load, swing, walls, said):
    observable = WallLoad(**given)
    case = hard([observable], number=50, size=(9, 20), **FALL | {"walls": [*map(Plates, walls)]})
    spheres = Placed(case, lambda time: column(case, 5, 10), np.zeros((2 * len(walls), 2)))
    accumulator = observable.accumulator(case)
    drawn = np.random.default_rng(7).normal(size=40)
    loads = load + swing * (drawn - drawn.mean())
    for impulse in np.cumsum(loads) * spheres.masses().sum():
        accumulator.observe(spheres)
        spheres.advance(1)
        spheres.wall_impulse[-2, 1] = -impulse
    accumulator.observe(spheres)
    note = by_name(accumulator.result())["load on the floor over the weight"].note
    assert [key for key, words in NOTES.items() if words in note] == said
    assert bool(note) == bool(said)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_plates_give_stress_ratio_and_inertial_number(sign):
    observable = ShearRheology(margin=1.0)
    plates = Plates("y", upper=Surface(velocity=(sign * 2.0, 0.0)))
    case = hard([observable], number=100, size=(10, 20), walls=[plates])
    # on 10 of plate: a pressure of 3, and a shear stress of 0.9
    taken = [[sign * 9.0, -30.0], [-sign * 9.0, 30.0]]
    rows = np.random.default_rng(5).random((100, 2)) * [10, 20]
    spheres = Placed(case, lambda time: rows, taken)
    accumulator = observable.accumulator(case)
    for _ in range(20):
        spheres.advance(1)
        spheres.v = np.stack([0.02 * sign * rows[:, 1] + 0.5, np.zeros(100)], 1)
        accumulator.observe(spheres)
    result = accumulator.result()
    found = by_name(result)
    mass = case.spheres.kinds[0].mean_mass(2)
    assert found["shear rate"].measured == pytest.approx(0.02 * sign)
    assert found["shear rate"].expected == pytest.approx(0.1 * sign)
    assert found["pressure"].measured == pytest.approx(3.0)
    assert found["shear stress"].measured == pytest.approx(0.9)
    inertial = 0.02 * math.sqrt(mass / 3.0)
    assert found["inertial number"].measured == pytest.approx(inertial)
    ratio = found["shear stress over pressure"]
    assert ratio.measured == pytest.approx(0.3)
    assert ratio.expected == pytest.approx(0.25 + 1.1 * inertial)
    assert np.nanmax(abs(result.fit - result.value)) < 0.05


def test_a_flow_that_builds_up_is_not_steady():
    observable = ShearRheology(margin=0.0)
    case = hard([observable], number=100, size=(10, 20), walls=[Plates("y")])
    rows = np.random.default_rng(7).random((100, 2)) * [10, 20]
    spheres = Placed(case, lambda time: rows, np.zeros((2, 2)))
    accumulator, noise = observable.accumulator(case), np.random.default_rng(8)
    for k in range(41):
        spheres.advance(1)
        rate = 0.02 * (k > 20) + 0.001 * noise.normal()
        spheres.v = np.stack([rate * rows[:, 1], np.zeros(100)], 1)
        accumulator.observe(spheres)
    assert not accumulator.result()["shear rate"].steady


def test_a_bed_that_fills_half_of_its_box_is_as_dense_as_its_lattice():
    observable = ShearRheology(margin=2.0)
    case = hard([observable], number=100, size=(10, 20), packing_fraction=None, walls=[Plates("y")])
    rows = np.stack(np.meshgrid(np.arange(10), np.arange(10)), -1).reshape(-1, 2) + 0.5
    result = after(observable, case, Placed(case, lambda time: rows, np.zeros((2, 2))))
    assert result["depth of the bed"].measured == pytest.approx(10.0)
    assert result["packing fraction"].measured == pytest.approx(math.pi / 4, rel=1e-9)


@pytest.mark.parametrize("counted", [False, True])
def test_the_books_of_energy_close(counted):
    observable = EnergyBudget()
    case = hard([observable], number=20, size=(9, 9), **FALL)
    spheres = FakeSpheres(case)
    lost = {"impact": 0.0, "friction": 0.0, "rolling": 0.0}
    held = {"translation": 5.0, "rotation": 1.0, "potential": 30.0}
    spheres.energies = lambda: dict(held)
    if counted:
        spheres.lost = lost
    accumulator = observable.accumulator(case)
    for _ in range(10):
        accumulator.observe(spheres)
        spheres.step += 1
        held["potential"] -= 1.5
        held["translation"] += 0.5
        lost["impact"] += 0.75
        lost["friction"] += 0.25
    result = accumulator.result()
    found = by_name(result)
    assert found["energy lost"].measured == pytest.approx(9.0)
    assert result.value.shape == (10, 6 if counted else 4)
    books = found.get("energy with losses over that at first")
    assert (books is not None) == counted
    assert books is None or (books.measured == pytest.approx(1.0) and books.expected == 1.0)
    names = result.x["of"].tolist()
    assert ("lost to friction" in names) == counted


def test_a_sheared_box_gives_stress_ratio_by_motion_and_contacts():
    observable = ShearRheology()
    plain = hard([], number=100, size=(10, 20))
    box = Box([10, 20], shear_rate=-0.05)
    case = SimpleNamespace(box=box, walls=(), spheres=plain.spheres, particles=100)
    rows = np.random.default_rng(6).random((100, 2)) * [10, 20]
    spheres = Placed(plain, lambda time: rows)
    spheres.v = np.stack([-0.05 * (rows[:, 1] - 10), np.zeros(100)], 1)
    spheres.stress = {
        "kinetic": np.array([[-7.0, -0.1], [-0.1, -0.5]]),
        "pair": np.array([[-2.0, -0.4], [-0.4, -1.5]]),
    }
    accumulator = observable.accumulator(case)
    for _ in range(20):
        accumulator.observe(spheres)
    found = by_name(accumulator.result())
    assert found["shear rate"].measured == pytest.approx(-0.05)
    assert found["shear rate"].expected == -0.05
    assert found["pressure"].measured == pytest.approx(2.0)
    assert found["shear stress over pressure"].measured == pytest.approx(0.25)
    known = whole(0.5 * spheres.diameters(), 2).sum() / 200
    assert found["packing fraction"].measured == pytest.approx(known, rel=0.01)
