"""Sweeps of pybullet over the contacts of a bed of spheres, timed on demand.

Python of an environment with pybullet runs it:

    PYTHON bed_pybullet.py BED WIDTH SWEEPS [--settle STEPS] [--write FILE] [--multibody]

BED is an array file (.npy) with a row for each sphere: x, y, z, radius. The bin is square and WIDTH
wide, with a floor at 0, gravity 1 and friction 0.5. At each line that it reads it prints
nanoseconds of CPU time for a contact and sweep, the contacts, those of them that touch, and the
part of weights that is not balanced.

Contacts are all that Bullet's solver has in a step, with a gap or without: Bullet gives rows to
each point of its manifolds, within its margin. Spheres are rigid bodies (in maximal coordinates),
twice as fast there as multibodies; no sleep, no early end of the sweeps.
"""

import argparse
import math
import sys
import time

import numpy as np
import pybullet as bullet

TIMESTEP, FRICTION, DENSITY = 0.005, 0.5, 6 / math.pi  # mass 1 of a sphere with diameter 1
EACH = math.sqrt(FRICTION)  # Bullet multiplies those of two bodies
THICK = 1.0  # half of a wall
STEPS = 10  # between two looks at the clock


def body(shape: int, mass: float, place: list[float], multibody: bool) -> int:
    """A body with the friction of all, that never sleeps."""
    made = bullet.createMultiBody(
        mass, shape, basePosition=place, useMaximalCoordinates=0 if multibody else 1
    )
    bullet.changeDynamics(
        made, -1, lateralFriction=EACH, spinningFriction=0, rollingFriction=0, restitution=0,
        linearDamping=0, angularDamping=0,
    )  # fmt: skip
    return made


def bed(spheres: np.ndarray, width: float, sweeps: int, multibody: bool) -> list[int]:
    """Spheres in a bin."""
    bullet.connect(bullet.DIRECT)
    bullet.setGravity(0, 0, -1)
    bullet.setTimeStep(TIMESTEP)
    bullet.setPhysicsEngineParameter(
        numSolverIterations=sweeps, numSubSteps=0, solverResidualThreshold=0.0,
        restitutionVelocityThreshold=0.0, deterministicOverlappingPairs=0,
    )  # fmt: skip
    half, high = width / 2, 3 * spheres[:, 2].max()
    for axis in range(3):
        for side in (-1, 1) if axis < 2 else (-1,):
            extents = [half + 2 * THICK, half + 2 * THICK, high]
            extents[axis] = THICK
            centre = [half, half, 0.0]
            centre[axis] = -THICK if side < 0 else width + THICK
            box = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=extents)
            body(box, 0.0, centre, multibody)
    made = []
    for *place, radius in spheres.tolist():
        ball = bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=radius)
        made.append(body(ball, DENSITY * 4 / 3 * math.pi * radius**3, place, multibody))
    return made


def gaps() -> np.ndarray:
    """Gaps of all contacts of the last step."""
    return np.array([point[8] for point in bullet.getContactPoints()])


def unbalanced(made: list[int]) -> float:
    """Root mean square of what is left of the weight of spheres after a step from rest."""
    speeds = np.array([bullet.getBaseVelocity(one)[0] for one in made])
    return float(np.sqrt((speeds**2).sum(axis=1).mean()) / TIMESTEP)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bed")
    parser.add_argument("width", type=float)
    parser.add_argument("sweeps", type=int)
    parser.add_argument("--settle", type=int, default=0)
    parser.add_argument("--write")
    parser.add_argument("--multibody", action="store_true")
    given = parser.parse_args()
    spheres = np.load(given.bed)
    made = bed(spheres, given.width, given.sweeps, given.multibody)
    for _ in range(given.settle):
        bullet.stepSimulation()
    if given.write:
        places = [bullet.getBasePositionAndOrientation(one)[0] for one in made]
        np.save(given.write, np.column_stack([places, spheres[:, 3]]))
    print("ready", flush=True)
    for _ in sys.stdin:
        before = gaps()
        began = time.process_time()
        for _ in range(STEPS):
            bullet.stepSimulation()
        took = (time.process_time() - began) / STEPS
        both = [before, gaps()]
        mean, touching = np.mean([(len(each), (each <= 0).sum()) for each in both], axis=0)
        print(1e9 * took / (mean * given.sweeps), mean, touching, unbalanced(made), flush=True)


if __name__ == "__main__":
    main()
