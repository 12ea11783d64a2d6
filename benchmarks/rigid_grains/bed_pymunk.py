"""Sweeps of pymunk over the contacts of a bed of disks, timed on demand.

Python of an environment with pymunk runs it:

    PYTHON bed_pymunk.py BED WIDTH SWEEPS [--settle STEPS] [--write FILE]
    PYTHON bed_pymunk.py BED WIDTH SWEEPS,SWEEPS,.. --cold [--settle STEPS]

BED is an array file (.npy) with a row for each disk: x, y, radius. The bin is WIDTH wide, with a
floor at 0, gravity 1 and friction 0.5. At each line that it reads it prints nanoseconds of CPU
time for a contact and sweep, the contacts, and the part of weights that is not balanced.

With `--cold` it prints a line for each number of sweeps: their number, seconds of CPU time for one
step of a new space, which has no impulses of an earlier step, and the largest change of an impulse
in the last sweep over the mean impulse, by a space with one sweep more.

Contacts are those that Chipmunk's solver has in the step: its arbiters, each once, of two bodies
or of one with a wall. Two circles have one contact point, as a circle and a segment have.
"""

import argparse
import math
import sys
import time

import numpy as np
import pymunk

TIMESTEP, FRICTION, DENSITY = 0.005, 0.5, 4 / math.pi  # mass 1 of a disk with diameter 1
EACH = math.sqrt(FRICTION)  # Chipmunk multiplies those of two shapes
SLOP = 1e-3  # overlap that Chipmunk leaves, in diameters
THICK = 1.0  # half of a wall
STEPS = 20  # between two looks at the clock
COUNTED = 4  # of them with their contacts counted, before and after


def bed(disks: np.ndarray, width: float, sweeps: int) -> pymunk.Space:
    """Disks in a bin."""
    space = pymunk.Space()
    space.gravity, space.iterations, space.collision_slop = (0.0, -1.0), sweeps, SLOP
    high = 3 * disks[:, 1].max()
    ends = [((-9, -THICK), (width + 9, -THICK))]
    ends += [((x, -9), (x, high)) for x in (-THICK, width + THICK)]
    for a, b in ends:
        wall = pymunk.Segment(space.static_body, a, b, THICK)
        wall.friction = EACH
        space.add(wall)
    for x, y, r in disks:
        mass = DENSITY * math.pi * r * r
        body = pymunk.Body(mass, mass * r * r / 2)
        body.position = x, y
        disk = pymunk.Circle(body, r)
        disk.friction = EACH
        space.add(body, disk)
    return space


def contacts(space: pymunk.Space) -> int:
    """How many contacts the last step had."""
    found = set()

    def note(arbiter: pymunk.Arbiter) -> None:
        if len(arbiter.contact_point_set.points) != 1:
            raise RuntimeError("a contact of more than one point")
        found.add(tuple(sorted(map(id, arbiter.shapes))))

    for body in space.bodies:
        body.each_arbiter(note)
    return len(found)


def places(space: pymunk.Space) -> np.ndarray:
    """The disks again: x, y, radius."""
    return np.array([(*b.position, next(iter(b.shapes)).radius) for b in space.bodies])


def velocities(space: pymunk.Space) -> np.ndarray:
    """Of all disks, in units of a step of free fall."""
    return np.array([tuple(body.velocity) for body in space.bodies]) / TIMESTEP


def size(speeds: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt((speeds**2).sum(axis=1).mean()))


def impulses(space: pymunk.Space) -> np.ndarray:
    """Of all contacts of the last step, in the order of the bodies."""
    found = []
    for body in space.bodies:
        body.each_arbiter(lambda arbiter: found.append(tuple(arbiter.total_impulse)))
    return np.array(found)


def cold(disks: np.ndarray, width: float, sweeps: list[int]) -> None:
    """Print how a first step comes nearer to its end with more sweeps."""
    for most in sweeps:
        both = []
        for done in (most + 1, most):
            space = bed(disks, width, done)
            began = time.process_time()
            space.step(TIMESTEP)
            took = time.process_time() - began
            both.append(impulses(space))
        mean = np.hypot(*both[1].T).mean()
        print(most, took, np.abs(both[0] - both[1]).max() / mean, flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bed")
    parser.add_argument("width", type=float)
    parser.add_argument("sweeps", type=lambda text: [int(each) for each in text.split(",")])
    parser.add_argument("--settle", type=int, default=0)
    parser.add_argument("--write")
    parser.add_argument("--cold", action="store_true")
    given = parser.parse_args()
    disks, sweeps = np.load(given.bed), given.sweeps[-1]
    space = bed(disks, given.width, sweeps if not given.cold else 100)
    for _ in range(given.settle):
        space.step(TIMESTEP)
    if given.cold:
        cold(places(space), given.width, given.sweeps)
        return
    if given.write:
        np.save(given.write, places(space))
    print("ready", flush=True)
    for _ in sys.stdin:
        took, counts = 0.0, []
        for _ in range(STEPS // COUNTED):
            space.step(TIMESTEP)
            counts.append(contacts(space))
            began = time.process_time()
            for _ in range(COUNTED):
                space.step(TIMESTEP)
            took += time.process_time() - began
        took /= len(counts) * COUNTED
        counts.append(contacts(space))
        mean = float(np.mean(counts))
        print(1e9 * took / (mean * sweeps), mean, size(velocities(space)), flush=True)


if __name__ == "__main__":
    main()
