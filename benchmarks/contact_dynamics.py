"""Contact dynamics: time of a sweep over a contact, and forces, beside peers.

    python -m benchmarks.contact_dynamics BED SWEEPS [--threads N] [--wall]

prints nanoseconds for a contact and sweep, and the contacts, at each line that it reads: of CPU
time, or of wall time. BED is the number of a bed in BEDS. Beds at rest are kept in `build`.

Peers have environments of their own, Siconos those packages of Debian:

    python3 -m venv ENV && ENV/bin/pip install pymunk pybullet numpy
    apt-get install python3-siconos python3-h5py python3-scipy python3-lxml python3-vtk9
    PYMUNK=ENV/bin/python PYBULLET=ENV/bin/python SICONOS=/usr/bin/python3 \
        python -m benchmarks --only contact-dynamics

Without them their columns are empty. Contacts of mesokit are those with a force; its sweeps
go over others as well. Contacts of a peer are all those that its solver has.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from benchmarks.worker import ROOT, Worker, in_turn
from mesokit import Case, Simulation

SCRIPTS = ROOT / "benchmarks" / "rigid_grains"
KEPT = ROOT / "build" / "rigid_grains"  # beds at rest
TIMESTEP, FRICTION = 0.005, 0.5
APART = 1.25  # of places before the fall: the largest diameter is 1.2
SPREAD = 0.2  # of diameters
SETTLING, SETTLING_SWEEPS = 4000, 60
WARM, WARM_SWEEPS, STEPS = 500, 1000, 20  # before the clock starts, and between two looks
FEW_STEPS, FIRST_STEPS = 3, 12
SWEEPS = (100, 300, 1000, 3000, 10_000, 30_000)
ACCURACY = 1e-4  # residual
NEAR, NEXT = 1 - 2**-10, 1.01  # distances of grains that touch and that do not, in diameters
NO_END = 0.0  # residual that no sweep reaches: all are done
Array = Any


class Bed(NamedTuple):
    """Number of grains, and width of the bin."""

    number: int
    width: float
    dimension: int

    @property
    def file(self) -> Path:
        """Where it is kept."""
        return KEPT / f"{self.number}_in_{self.dimension}d.npy"


class Peer(NamedTuple):
    """A peer: its name, the bed, sweeps of a step, and the ratio asked for."""

    name: str
    bed: Bed
    sweeps: int
    asked: str

    def worker(self) -> Worker | None:
        """A process that times it, None where it is not installed."""
        if not (python := os.environ.get(self.name.upper())):
            return None
        given = [str(self.bed.file), str(self.bed.width), str(self.sweeps), "--settle", "300"]
        return Worker([python, str(SCRIPTS / f"bed_{self.name}.py"), *given])


DISKS, SPHERES, MANY = Bed(1500, 40.0, 2), Bed(640, 8.0, 3), Bed(20_000, 400.0, 2)
FEW = Bed(192, 5.5, 3)
PEERS = (
    Peer("pymunk", DISKS, 10, ""),
    Peer("pymunk", DISKS, 100, "1.5"),
    Peer("pybullet", SPHERES, 50, "5"),
    Peer("pybullet", SPHERES, 200, ""),
)
TWO = 1.5  # of two threads over one, asked for
BEDS = (DISKS, SPHERES, MANY, FEW)
SICONOS = 100  # times as fast as it, asked for


def case(
    number: int, dimension: int, width: float, height: float, spread: float = 0.0,
    sweeps: int = 100, tolerance: float = NO_END,
) -> Case:  # fmt: skip
    """Grains in a bin, or on a floor without walls at the sides where they have no spread."""
    axes = "xyz"[:dimension] if spread else "xyz"[dimension - 1]
    data = {
        "run": {"method": "contact-dynamics", "steps": 0},
        "box": {"size": [width] * (dimension - 1) + [height]},
        "wall": [{"shape": "plates", "axis": axis} for axis in axes],
        "spheres": {
            "number": number,
            "kinds": [{"spread": spread}],  # mass 1 of a diameter of 1
            "gravity": [0.0] * (dimension - 1) + [-1.0],
            "timestep": TIMESTEP,
            "contact": {"friction": FRICTION},
            "solver": {"rule": "gauss-seidel", "sweeps": sweeps, "tolerance": tolerance},
        },
    }
    return Case.from_data(data, ROOT)


def at_rest(case: Case, places: Array, threads: int = 1) -> Any:
    """The engine with grains at these places, without motion."""
    n, d = places.shape
    spins = np.zeros(n if d == 2 else (n, 3))
    given = {"positions": places, "velocities": np.zeros((n, d)), "spins": spins}
    return Simulation(case, threads=threads, **given).engine


def bin_of(bed: Bed, sweeps: int, tolerance: float = NO_END) -> Case:
    """The case of a bed."""
    layers = bed.number / int(bed.width // APART) ** (bed.dimension - 1)
    height = APART * (math.ceil(layers) + 12)
    return case(bed.number, bed.dimension, bed.width, height, SPREAD, sweeps, tolerance)


def loose(bed: Bed) -> Array:
    """Places on a lattice, shaken, far enough apart."""
    rng = np.random.default_rng(1)
    d, row = bed.dimension, int(bed.width // APART)
    number = np.arange(bed.number)
    axes = [number // row**k % row for k in range(d - 1)] + [number // row ** (d - 1)]
    spacing = np.array([bed.width / row] * (d - 1) + [APART])
    places = (np.stack(axes, 1) + 0.5) * spacing
    return places + rng.uniform(-0.02, 0.02, places.shape)


def settled(bed: Bed) -> Array:
    """Grains at rest: place and radius, a row for each."""
    if not bed.file.exists():
        falls = at_rest(bin_of(bed, SETTLING_SWEEPS, 1e-4), loose(bed), threads=2)
        falls.advance(SETTLING)
        KEPT.mkdir(parents=True, exist_ok=True)
        np.save(bed.file, np.column_stack([falls.positions(), falls.diameters() / 2]))
    return np.load(bed.file)


def settled_engine(bed: Bed, sweeps: int, threads: int, tolerance: float = NO_END) -> Any:
    """The engine of a bed at rest, with its forces: with few sweeps from none it would sink."""
    places = settled(bed)[:, :-1]
    first = at_rest(bin_of(bed, WARM_SWEEPS, ACCURACY), places, threads)
    first.advance(WARM)
    then = at_rest(bin_of(bed, sweeps, tolerance), places, threads)
    then.restore(first.state())
    then.advance(STEPS)
    return then


def touching(engine: Any) -> int:
    """How many contacts have a force."""
    return len(engine.contacts().pairs)


def work(bed: Bed, sweeps: int, threads: int, wall: bool) -> None:
    """Time sweeps, a line for each line that is read."""
    grains = settled_engine(bed, sweeps, threads)
    clock = time.perf_counter if wall else time.process_time
    print("ready", flush=True)
    for _ in sys.stdin:
        before, began = touching(grains), clock()
        grains.advance(STEPS)
        took = (clock() - began) / STEPS
        contacts = (before + touching(grains)) / 2
        print(1e9 * took / (contacts * sweeps), contacts, flush=True)


def ours(bed: Bed, sweeps: int, *more: str) -> Worker:
    """mesokit."""
    given = [str(BEDS.index(bed)), str(sweeps), *more]
    return Worker([sys.executable, "-m", "benchmarks.contact_dynamics", *given])


def first_step(bed: Bed, sweeps: Sequence[int]) -> list[tuple[int, float, float]]:
    """How a first step comes nearer to its end with more sweeps: their number, seconds of CPU time,
    and the largest change of an impulse in the last sweep over the mean impulse."""
    places, found = settled(bed)[:, :-1], []
    at_rest(bin_of(bed, sweeps[0]), places).advance(1)  # compiles
    for most in sweeps:
        grains = at_rest(bin_of(bed, most), places)
        began = time.process_time()
        grains.advance(1)
        found.append((most, time.process_time() - began, grains.system.last_solved()[1]))
    return found


def first_step_of_pymunk(bed: Bed, sweeps: Sequence[int]) -> list[tuple[int, float, float]] | None:
    """The same of pymunk, None where it is not installed."""
    if not (python := os.environ.get("PYMUNK")):
        return None
    command = [python, str(SCRIPTS / "bed_pymunk.py"), str(bed.file), str(bed.width)]
    command += [",".join(map(str, sweeps)), "--cold", "--settle", "300"]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    rows = [line.split() for line in done.stdout.splitlines()]
    return [(int(most), float(took), float(error)) for most, took, error in rows]


def column() -> Array:
    """Twenty disks on one another, their overlap so large that rounding opens no contact."""
    return np.array([[0.0, NEAR * (0.5 + i)] for i in range(20)])


def three_disks() -> Array:
    """One on two, which do not touch one another."""
    x = NEXT / 2
    return np.array([[-x, NEAR / 2], [x, NEAR / 2], [0.0, NEAR / 2 + math.sqrt(NEAR**2 - x**2)]])


def four_spheres() -> Array:
    """One on three, which do not touch one another."""
    away = NEXT / math.sqrt(3)
    turns = 2 * math.pi * np.arange(3) / 3
    below = [[away * math.cos(t), away * math.sin(t), NEAR / 2] for t in turns]
    return np.array([*below, [0.0, 0.0, NEAR / 2 + math.sqrt(NEAR**2 - away**2)]])


def forces(places: Array) -> Array:
    """Forces by mesokit: a row for each contact, as those of `forces_siconos.py`."""
    n, d = places.shape
    size = 2 * (math.ceil(places.max()) + 3)
    given = case(n, d, size, size, sweeps=100_000, tolerance=1e-12)
    grains = at_rest(given, places + np.array([size / 2] * (d - 1) + [0.0]))
    grains.advance(FEW_STEPS)
    found = grains.contacts()
    pairs = np.where(found.pairs < 0, -1, found.pairs)
    rows = np.column_stack([pairs, found.forces])
    return rows[np.lexsort((rows[:, 1], rows[:, 0]))]


def siconos(grains: Array, *more: str) -> tuple[Array, float, int] | None:
    """Forces by Siconos, seconds for a step and contacts; None where it is not installed.

    Disks are spheres in a plane: normals of its contacts of disks are wrong by two degrees.
    """
    if not (python := os.environ.get("SICONOS")):
        return None
    flat = grains.shape[1] == 3
    if flat:
        grains = np.insert(grains, 1, 0.0, axis=1)
    with tempfile.TemporaryDirectory() as folder:
        given, out = Path(folder) / "grains.npy", Path(folder) / "forces.npy"
        np.save(given, grains)
        command = [python, str(SCRIPTS / "forces_siconos.py"), given, out, str(FRICTION), *more]
        done = subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True)
        took, contacts = done.stdout.splitlines()[-1].split()
        found = np.load(out)
    return np.delete(found, 3, axis=1) if flat else found, float(took), int(contacts)


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Beside peers, on two threads, to an accuracy, and forces."""
    rounds = max(rounds, 3)
    looks = max(rounds, round(seconds * rounds))
    for bed in BEDS:
        settled(bed)
    yield "## Contact dynamics"
    yield ""
    yield from _beside(looks)
    yield ""
    yield from _threads(looks)
    yield ""
    yield from _sweeps()
    yield ""
    yield from _beside_siconos()


def _beside(looks: int) -> Iterator[str]:
    yield (
        "Grains with diameters of 1 +- 0.2 at rest in a bin, friction 0.5, steps of 0.005: 1500 "
        "disks in a bin of width 40, and 640 spheres in one of 8 x 8. The peers start from the "
        "places that mesokit gives. Million contacts times sweeps per second of a core, the whole "
        "step in it; CPU time, medians of alternating looks, ratios of neighbouring ones."
    )
    yield ""
    yield (
        "| bed | sweeps | peer | mesokit | peer's | ratio | quartiles | contacts | peer's "
        "| asked for |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for peer in PEERS:
        found = in_turn([ours(peer.bed, peer.sweeps), peer.worker()], looks)
        mine, theirs = (1e3 / median(each[k][0] for each in found) for k in range(2))
        contacts = [median(each[k][1] for each in found) for k in range(2)]
        ratios = sorted(each[1][0] / each[0][0] for each in found)
        low, high = ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]
        start = f"| {peer.bed.number} in {peer.bed.dimension}D | {peer.sweeps} | {peer.name} "
        if theirs != theirs:
            yield f"{start}| {mine:.1f} | | | | {contacts[0]:.0f} | | {peer.asked} |"
            continue
        yield (
            f"{start}| {mine:.1f} | {theirs:.1f} | {median(ratios):.2f} | {low:.2f} to {high:.2f} "
            f"| {contacts[0]:.0f} | {contacts[1]:.0f} | {peer.asked} |"
        )


def _threads(looks: int) -> Iterator[str]:
    yield (
        f"Two threads over one, {MANY.number} disks in a bin of width {MANY.width:g}, coloured "
        f"order, 50 sweeps; wall time ({TWO:g} asked for):"
    )
    yield ""
    yield "| one thread | two threads | over one | quartiles |"
    yield "|---|---|---|---|"
    workers = [ours(MANY, 50, "--wall", "--threads", str(k)) for k in (1, 2)]
    found = in_turn(workers, looks)
    one, two = (1e3 / median(each[k][0] for each in found) for k in range(2))
    ratios = sorted(first[0] / second[0] for first, second in found)
    low, high = ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]
    yield f"| {one:.1f} | {two:.1f} | {median(ratios):.2f} | {low:.2f} to {high:.2f} |"


def _sweeps() -> Iterator[str]:
    yield (
        f"A first step of {DISKS.number} disks, without impulses of an earlier one: the largest "
        "change of an impulse in the last sweep over the mean impulse, and seconds of CPU time "
        "(pymunk's by a step with one sweep more)."
    )
    yield ""
    yield "| sweeps | mesokit | seconds | pymunk | seconds |"
    yield "|---|---|---|---|---|"
    mine, theirs = first_step(DISKS, SWEEPS), first_step_of_pymunk(DISKS, SWEEPS)
    for k, (most, took, change) in enumerate(mine):
        other = f"{theirs[k][2]:.1e} | {theirs[k][1]:.3f}" if theirs else " | "
        yield f"| {most} | {change:.1e} | {took:.3f} | {other} |"


def _from_no_forces(bed: Bed, grains: Array) -> Any:
    """The engine of a bed that has made no step."""
    return at_rest(bin_of(bed, 100_000, ACCURACY), grains[:, :-1])


def _one_step(engine: Any) -> float:
    """Seconds of CPU time of a step."""
    began = time.process_time()
    engine.advance(1)
    return time.process_time() - began


def _beside_siconos() -> Iterator[str]:
    yield (
        "Forces of contacts beside Siconos: the largest difference over the largest force (1e-4 "
        "asked for), and beside the exact force of the floor."
    )
    yield ""
    yield "| grains | contacts | Siconos's | difference | of the floor from the exact |"
    yield "|---|---|---|---|---|"
    for name, make, exact in PILES:
        places = make()
        own = forces(places)
        floor = np.abs(own[own[:, 1] == -1][:, -1] - exact).max()
        theirs = siconos(np.column_stack([places, np.full(len(places), 0.5)]))
        beside = " | "
        if theirs:
            alike = np.array_equal(own[:, :2], theirs[0][:, :2])
            off = np.abs(own - theirs[0])[:, 2:].max() / np.abs(own[:, 2:]).max() if alike else 1.0
            beside = f"{theirs[2]} | {off:.1e}"
        yield f"| {name} | {len(own)} | {beside} | {floor / exact:.1e} |"
    yield ""
    grains = settled(FEW)
    cold = 1e3 * median(_one_step(_from_no_forces(FEW, grains)) for _ in range(FIRST_STEPS))
    own = _from_no_forces(FEW, grains)
    mine = [_one_step(own) for _ in range(FIRST_STEPS)]
    next_ones, contacts = 1e3 * median(mine[1:]), touching(own)
    more = ("--steps", str(FIRST_STEPS), "--width", str(FEW.width), "--tolerance", str(ACCURACY))
    if other := siconos(grains, *more):
        yield (
            f"A step of {FEW.number} spheres at rest, to a residual of {ACCURACY:g} by the measure "
            f"of each; medians of {FIRST_STEPS}: Siconos {1e3 * other[1]:.0f} ms "
            f"({other[2]} contacts); mesokit {cold:.1f} ms from no forces ({contacts} contacts), "
            f"{1e3 * other[1] / cold:.0f} times as fast ({SICONOS} asked for), and "
            f"{next_ones:.2f} ms in the steps after it, from the forces of the one before."
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bed", type=lambda text: BEDS[int(text)])
    parser.add_argument("sweeps", type=int)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--wall", action="store_true")
    work(**vars(parser.parse_args()))


PILES: Sequence[tuple[str, Callable[[], Array], float]] = (
    ("column of 20 disks", column, 20.0),
    ("pile of three disks", three_disks, 1.5),
    ("pile of four spheres", four_spheres, 4 / 3),
)


if __name__ == "__main__":
    main()
