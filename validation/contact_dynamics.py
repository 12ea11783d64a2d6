"""Rigid grains: columns, slopes, piles, sweeps, beds, silos, columns that collapse, shear."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from common import BLUE, GREEN, RED, RUNS, SHORT, Page, main, mean_and_error, plt, sources

from mesokit import (
    Box,
    Case,
    Comparison,
    Plates,
    RandomStart,
    Rectangle,
    Run,
    Simulation,
    SphereKind,
    Surface,
    SurfaceContact,
    theory,
)
from mesokit.method.spheres.rigid.law.contact import RigidContact
from mesokit.method.spheres.rigid.section import RigidSpheres
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel
from mesokit.method.spheres.rigid.solver.jacobi import Jacobi
from mesokit.report.style import sparse_logarithm

NAME = "contact_dynamics"
UNIT, MIXED = SphereKind(1.0, mass=1.0), SphereKind(1.0, spread=0.2)
SEEDS = (1, 2)
EXACT = GaussSeidel(sweeps=100_000, tolerance=1e-12)
# from an independent program, in C
BED = {0.0: (4.01, 0.836, 1.001), 0.5: (3.28, 0.803, 0.933)}  # contacts, fraction, load of floor
COLUMN_SWEEPS = {8: 448, 16: 1778, 32: 7107}
OUTFLOW = {6: 8.95, 8: 16.4, 10: 24.7, 12: 36.2}  # grains of mean area, over sqrt(d/g)
OTHER_RUN_OUT = {0.76: 2.05, 1.63: 3.30, 3.15: 7.50, 6.28: 13.4}


def grains(
    size: Any,
    places: Any = None,
    walls: Any = (),
    seed: int = 1,
    rate: float = 0.0,
    contact: Any = None,
    velocities: Any = None,
    **given: Any,
) -> Any:
    """An engine of rigid grains at given places, or where their section puts them."""
    arrays: dict[str, Any] = {}
    if places is not None:
        places = np.array(places, float)
        still = np.zeros_like(places) if velocities is None else np.array(velocities, float)
        arrays = {"positions": places, "velocities": still}
        given = {"number": len(places), "start": RandomStart(), **given}
    case = Case(
        run=Run(0, method="contact-dynamics", seed=seed),
        box=Box(list(size), **({"shear_rate": rate} if rate else {})), walls=list(walls),
        spheres=RigidSpheres(
            **{"kinds": [UNIT], "contact": RigidContact(**(contact or {})), **given}
        ),
    )  # fmt: skip
    return Simulation(case, threads=1, **arrays).engine


def measured(page: Page, name: str, run: Callable[[], Any]) -> Any:
    """What a long run has found, read from build/validation if it is there."""
    file = RUNS / ("short" if SHORT else "") / NAME / f"{name}.json"
    if not file.exists():
        print(f"  running {name}", flush=True)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps({"sources": sources(), "found": run()}))
    kept = json.loads(file.read_text())
    page.sources.add(kept["sources"])
    return kept["found"]


def forces(engine: Any) -> tuple[Any, Any, Any]:
    """Pairs (m, 2), forces (m, d) on the first of each, and those of planes (n, walls, d)."""
    state, d = engine.state(), engine.dimension
    walls = state["wall_springs"].reshape(engine.n, -1, 3)[..., :d]
    step = engine.timestep
    return state["pairs"], state["springs"][:, :d] / step, walls / step


# --- single grains ------------------------------------------------------------------------------


def statics(page: Page) -> None:
    """Laws that hold to rounding."""
    page.heading("One and a few grains (C1 to C5, C7, C8)")
    page.text(
        "Largest deviation from the exact law, as a part of what is measured. Solved to a relative "
        "change of 1e-12 in a sweep."
    )
    rows: list[list[Any]] = []

    def row(what: str, found: float, bound: float) -> None:
        rows.append([what, f"{found:.1e}", f"{bound:.0e}"])
        page.check(f"{what}: off by {found:.1e} (at most {bound:.0e})", found < bound)

    n = 20
    engine = grains(
        (8, 30), [[4.0, 0.5 + i] for i in range(n)], [Plates("y")], gravity=[0.0, -1.0],
        timestep=0.01, solver=EXACT,
    )  # fmt: skip
    engine.advance(50)
    _, pairs, walls = forces(engine)
    found = np.concatenate([[walls[0, 0, 1]], np.linalg.norm(pairs, axis=1)])
    row("C1, column of 20: forces", np.abs(found / (n - np.arange(n)) - 1).max(), 1e-6)
    row("C2, disk on a slope: acceleration", _slope(), 1e-9)
    row("C3, from sliding to rolling: speed", _thrown(), 1e-9)
    coarse, fine = (abs(_apex(step)) for step in (1e-3, 1e-4))
    row("C4, fifth bounce, e = 0.8, step 1e-3: height", coarse, 1e-2)
    row("C4, the same, step 1e-4", fine, 1e-3)
    row("C7, groove of 30, 45 and 60 degrees: forces", _groove(), 1e-9)
    row("C8, row with gaps: all but the last at rest", _row(0.1), 1e-6)
    row("C8, touching row, by Newton's law", _row(0.0), 1e-6)
    page.grid(["law", "largest deviation", "bound"], rows)
    rows = []
    for d, name in ((2, "C5, three disks"), (3, "C6, four spheres")):
        least = theory.pile_friction(d)
        for grain, floor, stands in ((1.01, 1.01, True), (0.99, 1.01, False), (1.01, 0.99, False)):
            speed = _pile(d, grain * least.grains, floor * least.floor)
            rows.append(
                [
                    name,
                    f"{grain:.2f} x {least.grains:.5f}",
                    f"{floor:.2f} x {least.floor:.5f}",
                    f"{speed:.1e}",
                    "stands" if stands else "falls",
                ]
            )
            page.check(
                f"{name}, friction {grain:.2f}, floor {floor:.2f} of the least: speed {speed:.1e}, "
                f"{'stands' if stands else 'falls'}", (speed < 1e-6) == stands,
            )  # fmt: skip
    page.grid(["pile", "friction", "of the floor", "speed after time 1", "law"], rows)


def _on_floor(angle: float = 0.0, speed: float = 0.0) -> Any:
    return grains(
        (80, 5), [[5.0, 0.5]], [Plates("y")], velocities=[[speed, 0.0]], timestep=0.01,
        gravity=[math.sin(angle), -math.cos(angle)], contact={"friction": 0.2}, solver=EXACT,
    )  # fmt: skip


def _slope() -> float:
    worst = 0.0
    for over in (0.5, 0.99, 1.01, 2.0):
        angle = math.atan(over * 0.2 * 3)
        engine = _on_floor(angle)
        engine.advance(300)
        expected = theory.down_slope(angle, 0.2, 1.0, 0.5).acceleration * engine.time
        worst = max(worst, abs(engine.velocities()[0, 0] / expected - 1))
    return worst


def _thrown() -> float:
    engine, worst = _on_floor(speed=1.0), 0.0
    for _ in range(60):
        engine.advance(5)
        known = theory.slide_to_roll(engine.time, 1.0, 0.2, 1.0, 0.5)
        worst = max(worst, abs(engine.velocities()[0, 0] / float(known.speed) - 1))
    return worst


def _apex(timestep: float, e: float = 0.8, bounces: int = 5) -> float:
    fall = math.sqrt(2)
    apex = fall * (1 + 2 * sum(e**k for k in range(1, bounces)) + e**bounces)
    engine = grains(
        (4, 4), [[2.0, 1.5]], [Plates("y")], gravity=[0.0, -1.0], timestep=timestep,
        contact={"friction": 0.0, "restitution": e},
    )  # fmt: skip
    engine.advance(round(apex / timestep))
    (_, y), (_, v) = engine.positions()[0], engine.velocities()[0]
    return float((y - 0.5 + 0.5 * v * v + 0.5 * v * timestep) / e ** (2 * bounces) - 1)


def _groove() -> float:
    worst = 0.0
    for angle in (30.0, 45.0, 60.0):
        wide = math.radians(angle)
        up = np.array([[-math.sin(wide), math.cos(wide)], [math.sin(wide), math.cos(wide)]])
        walls = []
        for side, along in zip((-1, 1), up, strict=True):
            into = np.array([-side * along[1], side * along[0]])
            centre = np.array([16.0, 8.0]) + 3 * along - into
            turned = math.degrees(math.atan2(along[1], along[0]))
            walls.append(Rectangle(centre=centre.tolist(), size=[8, 2], angle=turned))
        engine = grains(
            (32, 20), [[16.0, 8 + 0.5 / math.sin(wide)]], walls, gravity=[0.0, -1.0],
            timestep=0.01, contact={"friction": 0.0}, solver=EXACT,
        )  # fmt: skip
        engine.advance(20)
        engine.end_warmup()
        engine.advance(100)
        force = np.linalg.norm(engine.wall_impulse, axis=1)  # in a time of 1
        worst = max(worst, np.abs(force * 2 * math.sin(wide) - 1).max())
    return float(worst)


def _row(gap: float, n: int = 5) -> float:
    places = [[3.0 + (1 + gap) * i, 4.0] for i in range(n)]
    engine = grains(
        (24, 8), places, velocities=[[1.0, 0.0]] + [[0.0, 0.0]] * (n - 1), timestep=0.003,
        contact={"friction": 0.0, "restitution": 1.0}, solver=EXACT,
    )  # fmt: skip
    engine.advance(400)
    last = np.eye(n)[-1]
    expected = last if gap else theory.touching_chain([1.0, *[0.0] * (n - 1)], 1.0)
    return float(np.abs(engine.velocities()[:, 0] - expected).max())


def _pile(d: int, friction: float, floor: float) -> float:
    if d == 2:
        places = np.array([[6.0, 0.5], [7.0, 0.5], [6.5, 0.5 + math.sqrt(3) / 2]])
    else:
        angles = 2 * math.pi * np.arange(3) / 3
        base = np.stack([np.cos(angles), np.sin(angles), 0 * angles], 1) / math.sqrt(3)
        places = np.array([6.0, 6.0, 0.5]) + np.array([*base, [0, 0, math.sqrt(2 / 3)]])
    lower = Surface(contact=SurfaceContact(friction=floor))
    engine = grains(
        [12.0] * (d - 1) + [5.0], places, [Plates("xyz"[d - 1], lower=lower)], timestep=0.01,
        gravity=[0.0] * (d - 1) + [-1.0], contact={"friction": friction},
        solver=GaussSeidel(sweeps=20_000, tolerance=1e-10),
    )  # fmt: skip
    engine.advance(100)
    return float(np.abs(engine.velocities()).max())


# --- sweeps -------------------------------------------------------------------------------------

DEEP = 1e-3  # overlap of neighbours in a ring, so that waves open no contact


def ring(n: int, solver: Any, velocities: Any = None) -> Any:
    """A periodic row of grains whose contacts had an impulse of 1 in the last step."""
    places = np.array([[(i + 0.25) * (1 - DEEP), 2.0] for i in range(n)])
    engine = grains(
        (n * (1 - DEEP), 4), places, velocities=velocities, contact={"friction": 0.0},
        timestep=1.0, solver=solver,
    )  # fmt: skip
    pairs = np.array([[0, 1], [0, n - 1], *[[i, i + 1] for i in range(1, n - 1)]])
    springs = np.zeros((n, 3))
    springs[:, 0] = -1.0  # on the first of two, whose other is to the right
    springs[1, 0] = 1.0
    engine.restore(engine.state() | {"pairs": pairs, "springs": springs})
    return engine


def spreading(order: str, steps: int, space: int = 50) -> Any:
    """Half the mean square distance to which one sweep carries a change, for each change."""
    n, bump = 40 * space, 1e-3
    way = Jacobi if order == "jacobi" else GaussSeidel
    named = {} if order == "jacobi" else {"order": order}
    engine = ring(n, way(**named, sweeps=1, tolerance=0))
    first = engine.state()
    pairs, springs = first["pairs"], first["springs"].copy()
    chain = np.where(pairs[:, 1] - pairs[:, 0] == 1, pairs[:, 0], n - 1)
    springs[chain % space == space // 2] *= 1 + bump
    far, found = np.arange(space) - space // 2, []
    for step in range(steps):
        engine.restore(first | {"springs": springs, "step": np.array(step)})
        engine.advance(1)
        force = np.empty(n)
        force[chain] = np.linalg.norm(engine.state()["springs"], axis=1)
        kernel = ((force - 1) / bump).reshape(-1, space)[5:-5].mean(axis=0)
        found.append(0.5 * kernel @ far**2)
    return found


def wave(n: int, sweeps: int, order: str) -> Any:
    """Frequency and decay of a standing wave in a ring, by a fit."""
    from scipy.optimize import curve_fit

    k = 2 * math.pi / n
    shape = np.cos(k * (np.arange(n) + 0.25))
    engine = ring(
        n, GaussSeidel(order, sweeps=sweeps, tolerance=0), np.stack([1e-6 * shape, 0 * shape], 1)
    )
    known = theory.rigid_chain_wave(k, sweeps, 1.0, order)
    found = []
    for _ in range(round(6 * math.pi / float(known.frequency))):
        engine.advance(1)
        found.append(engine.velocities()[:, 0] @ shape / (shape @ shape) / 1e-6)
    t = np.arange(1, len(found) + 1)
    (_, _, w, g), _ = curve_fit(
        lambda t, a, b, w, g: np.exp(-g * t) * (a * np.cos(w * t) + b * np.sin(w * t)),
        t, found, p0=(1.0, 0.0, float(known.frequency), float(known.decay)),
    )  # fmt: skip
    return w, g, t, np.array(found)


def column_error(n: int, order: str, sweeps: int) -> float:
    """Largest error of a force in a column over its weight, after sweeps that begin from none."""
    engine = grains(
        (8, n + 4), [[4.0, 0.5 + i] for i in range(n)], [Plates("y")], gravity=[0.0, -1.0],
        timestep=1e-3, contact={"friction": 0.0},
        solver=GaussSeidel(order, sweeps=sweeps, tolerance=0),
    )  # fmt: skip
    engine.advance(1)
    pairs, found, _ = forces(engine)
    force = np.zeros(n - 1)
    force[pairs[:, 0]] = np.linalg.norm(found, axis=1)
    return float(np.abs(force - (n - 1 - np.arange(n - 1))).max() / n)


def triangular(relaxation: float, sweeps: int, side: int = 8) -> float:
    """Residual velocity after sweeps over all contacts at once in a triangular lattice."""
    rows, columns = np.divmod(np.arange(side * side), side)
    height = math.sqrt(3) / 2
    places = np.stack([columns + 0.5 * (rows % 2) + 0.3, (rows + 0.3) * height], 1) * (1 - DEEP)
    engine = grains(
        np.array([side, side * height]) * (1 - DEEP), places, contact={"friction": 0.0},
        kinds=[SphereKind(1.0, mass=1.0, spread=1e-12)], timestep=1e-3,  # not refused as too dense
        solver=Jacobi(relaxation=relaxation, sweeps=sweeps, tolerance=0),
    )  # fmt: skip
    up, right, me = ((rows + 1) % side) * side, (columns + rows % 2) % side, np.arange(side**2)
    beside = (rows * side + (columns + 1) % side, up + right, up + (right - 1) % side)
    pairs = np.unique(np.sort(np.concatenate([np.stack([me, b], 1) for b in beside]), 1), axis=0)
    apart = places[pairs[:, 0]] - places[pairs[:, 1]]
    apart -= engine.box * np.rint(apart / engine.box)
    size = 1 + np.random.default_rng(1).normal(0, 1e-9, len(pairs))
    normals = apart / np.linalg.norm(apart, axis=1)[:, None]
    springs = np.pad(size[:, None] * normals, ((0, 0), (0, 1)))
    engine.restore(engine.state() | {"pairs": pairs, "springs": springs})
    engine.advance(1)
    return float(np.linalg.norm(engine.velocities()))


def sweeps(page: Page, axis: Any) -> None:
    """How forces spread and settle."""
    page.heading("Sweeps (C9, and 6.3)")
    page.text(
        "How far one sweep over a chain of contacts carries a change of force; frequency and decay "
        "of standing waves of a rigid chain with a fixed number of sweeps in a step, by a fit; "
        "sweeps in random order to 1e-6 of the weight of a column (known from an independent "
        "program); "
        "decay of the slowest error of a chain of 15 contacts; growth of errors where all contacts "
        "of a triangular lattice change at once."
    )
    rows = []
    spread = spreading("random", 400)
    rows.append(
        Comparison("spread, random", *mean_and_error(spread), theory.sweep_spread("random"))
    )
    for order in ("ordered", "jacobi"):
        value = spreading(order, 1)[0]
        rows.append(Comparison(f"spread, {order}", value, 1e-6, theory.sweep_spread(order)))
    first = rows[0]
    page.check(
        f"spread of a random sweep: {first.measured:.4f} +- {first.error:.4f} "
        f"({first.expected:.4f}, within 1 % and 3.5 s.e.)",
        abs(first.percent) < 1 and abs(first.deviation) < 3.5,
    )
    page.check("spread of other orders: to 1e-5",
               all(abs(c.percent) < 1e-3 for c in rows[1:]))  # fmt: skip
    worst = 0.0
    for n, number in ((64, 5), (128, 5), (128, 20), (256, 20)):
        for order in ("random", "coloured"):
            w, g, t, found = wave(n, number, order)
            known = theory.rigid_chain_wave(2 * math.pi / n, number, 1.0, order)
            for what, value, right in (
                ("frequency", w, known.frequency),
                ("decay", g, known.decay),
            ):
                label = f"wave of {n}, {number} sweeps, {order}: {what}"
                rows.append(Comparison(label, value / float(right), math.nan, 1.0))
                worst = max(worst, abs(value / float(right) - 1))
            if (n, order) == (256, "random"):
                few = slice(None, None, 4)
                axis.plot(t[few], found[few], "o", mfc="white", ms=4, color=BLUE, label="measured")
                law = np.exp(-known.decay * t) * np.cos(known.frequency * t)
                axis.plot(t, law, "k--", lw=1, label="theory")
    page.check(f"standing waves: within {100 * worst:.2f} % of theory (at most 3 %)", worst < 0.03)
    axis.set(xlabel="steps", ylabel="wave of velocities over first")
    axis.legend()
    off = 0.0
    for n, known in COLUMN_SWEEPS.items():
        errors = [column_error(n, "random", round(part * known)) for part in (0.8, 1.2)]
        rate = math.log(errors[0] / errors[1]) / (0.4 * known)
        needed = 0.8 * known + math.log(errors[0] / 1e-6) / rate
        rows.append(Comparison(f"sweeps, column of {n}", needed, math.nan, known))
        off = max(off, abs(needed / known - 1))
    page.check(f"sweeps of columns: within {100 * off:.1f} % (at most 3 %)", off < 0.03)
    n = 15
    speeds = -0.1 * (np.arange(n + 1) - 0.5 * n)
    left = []
    for number in (150, 250):
        engine = grains(
            (n + 8, 8), [[4.0 + i, 4.0] for i in range(n + 1)], timestep=1e-3,
            velocities=np.stack([speeds, 0 * speeds], 1), contact={"friction": 0.0},
            solver=GaussSeidel("ordered", sweeps=number, tolerance=0),
        )  # fmt: skip
        engine.advance(1)
        left.append(np.abs(engine.velocities()[:, 0]).max())
    exponent = math.log(left[1] / left[0]) / 100
    known = 2 * math.log(math.cos(math.pi / (n + 1)))
    rows.append(Comparison("C9, decay per ordered sweep", exponent, math.nan, known))
    page.check(f"C9, exponent: {exponent:.5f} ({known:.5f}, within 2 %)",
               abs(exponent / known - 1) < 0.02)  # fmt: skip
    for relaxation in (1.0, 0.75, 0.6):
        growth = (triangular(relaxation, 22) / triangular(relaxation, 16)) ** (1 / 6)
        known = abs(theory.parallel_factor("triangular", relaxation))
        rows.append(Comparison(f"growth, all at once, relaxation {relaxation}", growth, math.nan,
                               known, "", "approximate: below 2/3 all errors fall, the slowest last"
                               if relaxation < 2 / 3 else ""))  # fmt: skip
    page.check(f"all at once: errors grow by {rows[-3].measured:.4f} (2, within 1 %)",
               abs(rows[-3].measured / 2 - 1) < 0.01)  # fmt: skip
    page.check(f"relaxation 0.6: {rows[-1].measured:.3f} (below 1)", rows[-1].measured < 1)
    page.table(rows)


# --- beds ---------------------------------------------------------------------------------------


BEDS = {0.0: (600, 25, 15_000), 0.5: (1500, 40, 12_000)}  # grains, width, steps to come to rest


def bed(friction: float, seed: int) -> Any:
    """Grains that have fallen into a bin."""
    number, wide, steps = BEDS[friction]
    engine = grains(
        (wide, 66), walls=[Plates("x"), Plates("y")], number=number, kinds=[MIXED], seed=seed,
        gravity=[0.0, -1.0], start=RandomStart(), contact={"friction": friction}, timestep=0.005,
        solver=GaussSeidel(sweeps=100, tolerance=1e-5),
    )  # fmt: skip
    engine.advance(steps)
    return engine


def covered(engine: Any, low: float, high: float, sides: float) -> float:
    """Packing fraction between two heights, off both sides."""
    from scipy.spatial import cKDTree

    r, radii = engine.positions(), 0.5 * engine.diameters()
    points = np.random.default_rng(0).uniform(
        [sides, low], [engine.box[0] - sides, high], (200_000, 2)
    )
    distance, near = cKDTree(r).query(points, k=6)
    return float((distance < radii[near]).any(axis=1).mean())


def settled(friction: float, seed: int) -> dict[str, Any]:
    """Contacts of a grain, packing fraction, load of the floor, balance of forces; forces."""
    engine = bed(friction, seed)
    pairs, found, walls = forces(engine)
    sizes, at_walls = np.linalg.norm(found, axis=1), np.linalg.norm(walls, axis=2)
    least = 1e-6
    pairs, found, sizes = (x[sizes > least] for x in (pairs, found, sizes))
    touching = np.bincount(pairs.ravel(), minlength=engine.n) + (at_walls > least).sum(axis=1)
    held = touching >= 2
    contacts = touching[held].sum() + (at_walls[held] > least).sum()  # one of a wall counts twice
    total = walls.sum(axis=1)
    np.add.at(total, pairs[:, 0], found)
    np.add.at(total, pairs[:, 1], -found)
    weight = engine.masses()[:, None] * np.array([0.0, -1.0])
    before = engine.wall_impulse[0, 1]
    taken, time = engine.wall_impulse[:, 1].sum(), engine.time
    momentum = engine.totals()[1][1]
    top = float(np.quantile(engine.positions()[:, 1], 0.9))
    return {
        "z": float(contacts / held.sum()),
        "phi": covered(engine, 5.0, top - 3.0, 3.0),
        "floor": float(walls[:, 2, 1].sum() / engine.masses().sum()),
        "residual": float(np.abs(total + weight)[held].max() / engine.masses().mean()),
        "books": float(abs((taken + momentum) / (engine.masses().sum() * time) + 1)),
        "forces": sizes.tolist(), "free": float(1 - held.mean()), "taken": float(before),
    }  # fmt: skip


def beds(page: Page, axis: Any) -> None:
    """Contacts, density, and forces of beds at rest."""
    page.heading("Poured beds (C10, C11)")
    page.text(
        "Disks of diameters 0.8 to 1.2 fall into a bin: 1500 with friction into one 40 wide, 600 "
        f"without into one 25 wide; {len(SEEDS)} seeds. Contacts of a grain count "
        "those with walls twice, and leave out grains that rest on nothing. "
        "'Theory' is an independent program; without friction z = 4 (isostatic). The packing "
        "fraction is that off the walls and the surface."
    )
    rows, worst, books = [], 0.0, 0.0
    for friction, known in BED.items():
        runs = [
            measured(page, f"bed_{friction}_{seed}", lambda f=friction, s=seed: settled(f, s))
            for seed in SEEDS
        ]
        for name, key, right in (
            ("contacts of a grain", "z", known[0]), ("packing fraction", "phi", known[1]),
            ("load of the floor over weight", "floor", known[2]),
        ):  # fmt: skip
            value, error = mean_and_error([run[key] for run in runs])
            rows.append(Comparison(f"mu = {friction}: {name}", value, error, right))
        worst = max(worst, *(run["residual"] for run in runs))
        books = max(books, *(run["books"] for run in runs))
        sizes = np.concatenate([np.array(run["forces"]) / np.mean(run["forces"]) for run in runs])
        counts, edges = np.histogram(sizes, np.linspace(0, 6, 31))
        density = counts / len(sizes) / np.diff(edges)
        error = np.sqrt(counts) / len(sizes) / np.diff(edges)
        some = counts > 0
        axis.errorbar(
            (0.5 * (edges[1:] + edges[:-1]))[some], density[some], error[some], ls="",
            marker="os"[friction > 0], mfc="white", ms=4, color=(BLUE, RED)[friction > 0],
            label=rf"$\mu$ = {friction}",
        )  # fmt: skip
        if friction > 0:
            beyond = sizes[sizes > 1.5] - 1.5
            x = np.array([1.5, 6.0])
            tail = np.exp(-(x - 1.5) / beyond.mean()) * len(beyond) / len(sizes) / beyond.mean()
            axis.plot(x, tail, "k--", lw=1, label=r"exponential, $\mu$ = 0.5")  # fmt: skip
            even = float(beyond.std() / beyond.mean())
            rows.append(Comparison("P(f) above 1.5 <f>: spread over mean", even,
                                   even / math.sqrt(len(beyond)), 1.0, "",
                                   "approximate: an exponential tail"))  # fmt: skip
    page.table(rows)
    for c in rows:
        if "contacts" in c.what:
            page.check(f"C10, {c.what}: {c.measured:.3f} ({c.expected}, within 2 %)",
                       abs(c.percent) < 2)  # fmt: skip
        if "fraction" in c.what:
            page.check(f"C10, {c.what}: {c.measured:.4f} ({c.expected}, within 0.01)",
                       abs(c.measured - c.expected) < 0.01)  # fmt: skip
    page.check(f"C11, largest force left on a grain: {worst:.1e} m g (at most 1e-3)", worst < 1e-3)
    page.check(f"C11, momentum of walls over weight and time, less 1: {books:.1e}", books < 1e-9)
    axis.set(xlabel=r"force over mean", ylabel="probability density", yscale="log")
    axis.legend()


# --- an hourglass -------------------------------------------------------------------------------

FLOOR = 40.0  # height of the floor with the hole


def hourglass(opening: float, seed: int, wide: int = 30, number: int = 1500) -> dict[str, Any]:
    """Grains that have left a bin through a hole, in time, and the packing fraction above it."""
    side = 0.5 * (wide - opening)
    height = FLOOR - 0.5
    walls = [
        Plates("x"), Plates("y"),
        Rectangle(centre=[0.5 * side - 0.5, height], size=[side + 1, 1]),
        Rectangle(centre=[wide - 0.5 * side + 0.5, height], size=[side + 1, 1]),
        Rectangle(centre=[0.5 * wide, height], size=[opening + 1, 1], opens=30.0),
    ]  # fmt: skip
    rng = np.random.default_rng(seed)
    row, column = np.divmod(np.arange(number), 23)
    places = np.stack([1.0 + 1.27 * column + rng.uniform(-0.02, 0.02, number),
                       FLOOR + 1.0 + 1.24 * row], 1)  # fmt: skip
    engine = grains(
        (wide, 126), places, walls, seed=seed, kinds=[MIXED], gravity=[0.0, -1.0], timestep=0.005,
        velocities=rng.normal(0, 0.7, (number, 2)), contact={"friction": 0.5},
        solver=GaussSeidel(sweeps=100, tolerance=1e-4),
    )  # fmt: skip
    engine.advance(6000)
    dense = covered(engine, FLOOR + 5, float(np.quantile(engine.positions()[:, 1], 0.9)) - 3, 3.0)
    left, times, mass = [], [], engine.masses()
    while not left or left[-1] < 0.5 * mass.sum():
        engine.advance(50)
        times.append(engine.time - 30.0)
        left.append(float(mass[engine.positions()[:, 1] < FLOOR - 1].sum()))
        if times[-1] > 200:
            break
    return {"times": times, "left": left, "dense": dense, "mass": float(mass.sum()),
            "area": float((engine.diameters() ** 2).mean())}  # fmt: skip


def outflow(page: Page, axis: Any) -> None:
    """Rates against openings."""
    page.heading("Outflow (C12)")
    page.text(
        "1500 disks of diameters 0.8 to 1.2, mu = 0.5, in a bin 30 wide with a hole D in its "
        "floor, "
        "while 10 to 50 % of them leave. Rates in squares of the mean diameter (`4 r^2`) over "
        "sqrt(d/g); errors from ten parts of a run. 'Theory' is an independent program, to 10 %."
    )
    rows, values, errors, halves = [], [], [], []
    for opening, known in OUTFLOW.items():
        run = measured(page, f"hourglass_{opening}", lambda d=opening: hourglass(d, 1))
        share = np.array(run["left"]) / run["mass"]
        times, number = np.array(run["times"]), share * 1500 * run["area"]
        during = (share > 0.1) & (share < 0.5)
        parts = np.array_split(np.flatnonzero(during), 10)
        rates = [float(np.polyfit(times[p], number[p], 1)[0]) for p in parts]
        value, error = mean_and_error(rates)
        (one, of_one), (two, of_two) = mean_and_error(rates[:5]), mean_and_error(rates[5:])
        what, error_of_two = f"D = {opening}: at 30 to 50 % over before", of_two / two
        halves.append(Comparison(what, two / one, math.hypot(of_one / one, error_of_two), 1.0))
        rows.append(Comparison(f"D = {opening}: rate", value, error, known))
        values.append(value)
        errors.append(error)
    openings = np.array(list(OUTFLOW), float)
    fit = theory.beverloo_fit(openings, values, errors, 1.0, 0.81, 1.0, 2)
    line = theory.beverloo_line(np.array(values), 2)
    straight = np.polyval(np.polyfit(openings, line, 1), openings)
    bent = float(np.abs(line / straight - 1).max())
    page.table(rows)
    page.table(halves)
    page.text(f"Fit of Beverloo's law: {fit}.")
    slope, zero = np.polyfit(openings, line, 1)
    k = -zero / slope
    for c in rows:
        page.check(f"C12, {c.what} {c.measured:.2f} ({c.expected}, within 15 %)",
                   abs(c.percent) < 15)  # fmt: skip
    page.check(
        f"C12, rate^(2/3) is linear in D within {100 * bent:.1f} % (at most 3 %)", bent < 0.03
    )
    page.check(f"C12, k = {k:.2f} (1 to 2.5)", 1 < k < 2.5)
    ratio, error = mean_and_error([c.measured for c in halves])
    page.check(
        f"C12, mean of rates at 30 to 50 % over before: {ratio:.3f} +- {error:.3f} (1, within "
        "10 %)", abs(ratio - 1) < 0.1,
    )  # fmt: skip
    axis.errorbar(openings, line, 2 / 3 * np.array(errors) / np.array(values) * line, fmt="o",
                  mfc="white", color=BLUE, label="measured")  # fmt: skip
    axis.plot(openings, theory.beverloo_line(np.array(list(OUTFLOW.values())), 2), "x", color=GREEN,
              label="independent program")  # fmt: skip
    x = np.array([k, 12.5])
    axis.plot(x, slope * (x - k), "k--", lw=1, label=f"line, k = {k:.2f}")
    axis.set(xlabel="opening D/d", ylabel=r"rate$^{2/3}$")
    axis.legend()


# --- columns that collapse ----------------------------------------------------------------------


def collapse(number: int, length: float, seed: int) -> dict[str, float]:
    """Aspect ratio of a column, and its run-out over its length."""
    contact, solver = {"friction": 0.5}, GaussSeidel(sweeps=100, tolerance=1e-4)
    high = int(1.8 * number / length) + 4
    column = grains(
        (length, high), walls=[Plates("x"), Plates("y")], number=number, kinds=[MIXED], seed=seed,
        gravity=[0.0, -1.0], start=RandomStart(), contact=contact, timestep=0.005, solver=solver,
    )  # fmt: skip
    column.advance(round(5 * math.sqrt(2 * high) / 0.005))
    places = column.positions()
    top = float(np.sort(places[:, 1])[-max(int(length / 2), 3) :].mean()) + 0.5
    wide = int(length * (2 + 1.6 * float(theory.run_out(top / length)))) + 10
    engine = grains(
        (wide, high), places, [Plates("x"), Plates("y")], seed=seed, kinds=[MIXED],
        gravity=[0.0, -1.0], contact=contact, timestep=0.005, solver=solver,
    )  # fmt: skip
    engine.advance(round(6 * math.sqrt(2 * top) / 0.005))
    ends = front(engine.positions())
    return {"a": top / length, "run": (ends - length) / length}


def front(places: Any) -> float:
    """Where the heap ends that hangs together: gaps wider than a diameter end it."""
    x = np.sort(places[:, 0])
    gaps = np.flatnonzero(np.diff(x) > 1.2)
    return float(x[gaps[0]] if len(gaps) else x[-1]) + 0.5


def collapses(page: Page, axis: Any) -> None:
    """Run-out against the aspect ratio."""
    page.heading("Columns that collapse (C13)")
    page.text(
        "Columns of disks, mu = 0.5, beside a wall; end of the heap that hangs together. "
        "Theory: contact dynamics of Staron and Hinch (2005); an independent program found "
        + ", ".join(f"{run} (a = {a})" for a, run in OTHER_RUN_OUT.items())
        + "."
    )
    rows = []
    for number, length in ((300, 20.0), (300, 13.0), (500, 12.0), (500, 8.0)):
        runs = [
            measured(page, f"collapse_{number}_{length:g}_{seed}",
                     lambda n=number, w=length, s=seed: collapse(n, w, s))
            for seed in SEEDS
        ]  # fmt: skip
        a, run = float(np.mean([x["a"] for x in runs])), [x["run"] for x in runs]
        known = float(theory.run_out(a))
        rows.append(Comparison(f"a = {a:.2f}: run-out", *mean_and_error(run), known))
        axis.errorbar([a], [rows[-1].measured], [rows[-1].error], fmt="o", mfc="white", color=BLUE)
    page.table(rows)
    for c in rows:
        page.check(f"C13, {c.what} {c.measured:.2f} ({c.expected:.2f}, within 25 %)",
                   abs(c.percent) < 25)  # fmt: skip
    axis.plot(list(OTHER_RUN_OUT), list(OTHER_RUN_OUT.values()), "x", color=GREEN,
              label="independent program")  # fmt: skip
    x = np.geomspace(0.6, 8, 100)
    axis.plot(x, theory.run_out(x), "k--", lw=1, label="Staron and Hinch")
    axis.set(xlabel="height over length", ylabel="run-out over length", xscale="log", yscale="log")
    sparse_logarithm(axis.xaxis, *axis.get_xlim())
    sparse_logarithm(axis.yaxis, *axis.get_ylim())
    axis.legend()


# --- shear --------------------------------------------------------------------------------------


def sheared(phi: float, seed: int, side: int = 18, rate: float = 0.2) -> dict[str, Any]:
    """Inertial number and friction of a sheared box at constant volume, in parts of a run."""
    engine = grains(
        (side, side), rate=rate, packing_fraction=phi, kinds=[SphereKind(1.0, spread=0.2)],
        seed=seed, start=RandomStart(), contact={"friction": 0.4}, timestep=0.01,
        solver=GaussSeidel(sweeps=100, tolerance=1e-4), push_back=0.02,
    )  # fmt: skip
    engine.advance(2000)
    parts = []
    for _ in range(8):
        found = np.zeros((2, 2))
        for _ in range(75):
            engine.advance(10)
            found += stress(engine, rate)
        parts.append((found / 75).tolist())
    return {"stress": parts, "mass": float(engine.masses().mean()), "rate": rate}


def stress(engine: Any, rate: float) -> Any:
    """Stress of forces and of momentum."""
    state, (width, height) = engine.state(), engine.box
    r = engine.positions() - engine.timestep * engine.velocities()
    offset = rate * height * (engine.time - engine.timestep)
    apart = r[state["pairs"][:, 0]] - r[state["pairs"][:, 1]]
    over = np.rint(apart[:, 1] / height)
    apart -= np.stack([offset * over, height * over], 1)
    apart[:, 0] -= width * np.rint(apart[:, 0] / width)
    total = (state["springs"][:, :2] / engine.timestep).T @ apart
    own = engine.velocities()
    own[:, 0] -= rate * (engine.positions()[:, 1] - 0.5 * height)
    return (total + (engine.masses()[:, None] * own).T @ own) / (width * height)


def shear_cell(page: Page, axis: Any) -> None:
    """Friction and density against the inertial number."""
    page.heading("Dense flow (C14)")
    page.text(
        "Disks, mu = 0.4, in a sheared box (Lees and Edwards) of constant volume; errors from "
        "eight parts of a run. Theory: da Cruz et al. (2005), at the inertial number measured."
    )
    rows = []
    for phi in (0.72, 0.75, 0.77):
        run = measured(page, f"shear_{phi}", lambda p=phi: sheared(p, 1))
        found = np.array(run["stress"])
        pressure = 0.5 * (found[:, 0, 0] + found[:, 1, 1])
        effective = -0.5 * (found[:, 0, 1] + found[:, 1, 0]) / pressure
        mean = float(pressure.mean())
        inertial = run["rate"] * math.sqrt(run["mass"] / mean)
        value, error = mean_and_error(effective)
        rows.append(Comparison(f"phi = {phi}, I = {inertial:.3f}: friction", value, error,
                               float(theory.friction_of_disks(inertial))))  # fmt: skip
        rows.append(Comparison(f"I = {inertial:.3f}: packing fraction", phi, math.nan,
                               float(theory.fraction_of_disks(inertial))))  # fmt: skip
        axis.errorbar([inertial], [value], [error], fmt="o", mfc="white", color=BLUE)
    page.table(rows)
    for c in rows:
        page.check(f"C14, {c.what} {c.measured:.3f} ({c.expected:.3f}, within 15 %)",
                   abs(c.percent) < 15)  # fmt: skip
    x = np.linspace(0.01, 0.3, 50)
    axis.plot(x, theory.friction_of_disks(x), "k--", lw=1, label="da Cruz et al.")
    axis.set(xlabel="inertial number", ylabel="friction of the flow")
    axis.legend()


def make() -> int:
    """Write the page."""
    page = Page(NAME, "Contact dynamics of rigid grains", "mean diameter, mass and gravity are 1")
    fig, axes = plt.subplots(2, 3, figsize=(11, 7))
    statics(page)
    sweeps(page, axes[0, 0])
    beds(page, axes[0, 1])
    outflow(page, axes[0, 2])
    collapses(page, axes[1, 0])
    shear_cell(page, axes[1, 1])
    axes[1, 2].set_axis_off()
    page.figure(fig, "A standing wave in a chain of 256 rigid grains; forces in beds; "
                "outflow from a bin; run-out of columns; friction of a sheared box.")  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
