"""Forces of contacts by Siconos, of grains at rest.

Python of the system runs it, with Debian's python3-siconos, -h5py, -scipy, -lxml and -vtk9:

    /usr/bin/python3 forces_siconos.py GRAINS FORCES FRICTION [--steps N] [--tolerance X]
        [--width W]

GRAINS is an array file (.npy) with a row for each sphere: x, y, z, radius. One of diameter 1 has
mass 1, and gravity is 1. They stand on a floor at z = 0, between walls at 0 and W where W is given.
The array file FORCES gets a row for each contact of the last step: numbers of two spheres, the
smaller first (-1 is the floor or a wall, second), and the force on the first. Printed are seconds
of CPU time for a step, without the first, and contacts: all in Siconos' index set 1, those that its
solver has.

Its disks are not used: normals of their contacts, from Bullet in 2D, are wrong by two degrees.
"""

import argparse
import contextlib
import io
import tempfile
import time
from pathlib import Path

import numpy as np
import siconos.kernel as kernel
import siconos.numerics as numerics
from siconos.io.mechanics_run import MechanicsHdf5Runner
from siconos.mechanics.collision.bullet import SiconosBulletOptions
from siconos.mechanics.collision.tools import Contactor

TIMESTEP, SWEEPS = 0.005, 100_000
UPRIGHT = [1.0, 0.0, 0.0, 0.0]
FIRST_FORCE = 10  # column of the impulse on the first grain of a contact
NO_MARGIN = {"insideMargin": 0.0, "outsideMargin": 0.0}


def scene(runner: MechanicsHdf5Runner, grains: np.ndarray, friction: float, width: float) -> None:
    """Spheres over a floor, and between walls."""
    reach = np.abs(grains if width else grains[:, :2]).max()
    extent = 2 * float(reach) + 16  # no wider: Bullet finds contacts in single precision
    middle = [width / 2, width / 2, 0.0]
    for axis, side in [(2, 0)] + [(a, s) for a in (0, 1) for s in (0, 1) if width]:
        size, place = [extent] * 3, list(middle)
        size[axis], place[axis] = 1.0, side * (width + 1) - 0.5
        name = f"wall{axis}{side}"
        runner.add_primitive_shape(name, "Box", size, **NO_MARGIN)
        runner.add_object(name, [Contactor(name)], translation=place, orientation=UPRIGHT)
    for number, (*place, radius) in enumerate(grains.tolist()):
        mass = (2 * radius) ** 3
        runner.add_primitive_shape(f"shape{number}", "Sphere", (radius,), **NO_MARGIN)
        runner.add_object(
            f"grain{number}", [Contactor(f"shape{number}")], translation=place,
            orientation=UPRIGHT, velocity=[0.0] * 6, mass=mass,
            inertia=[0.4 * mass * radius**2] * 3,
        )  # fmt: skip
    runner.add_Newton_impact_friction_nsl("contact", mu=friction, e=0.0)


def run(grains: np.ndarray, friction: float, width: float, steps: int, tolerance: float):
    """Contacts of the last step, and seconds of CPU time for each but the first."""
    options = kernel.solver_options_create(numerics.SICONOS_FRICTION_3D_NSGS)
    options.dparam[numerics.SICONOS_DPARAM_TOL] = tolerance
    options.iparam[numerics.SICONOS_IPARAM_MAX_ITER] = SWEEPS
    bullet = SiconosBulletOptions()
    bullet.worldScale = 1.0
    bullet.perturbationIterations = bullet.minimumPointsPerturbationThreshold = 0

    def weight(body) -> None:
        force = np.zeros(3)
        force[2] = -body.scalarMass()
        body.setFExtPtr(force)

    clocks, last = [], []

    def look(runner: MechanicsHdf5Runner) -> None:
        clocks.append(time.process_time())
        last[:] = [runner._io.contactPoints(runner._nsds, 1)]

    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "run.hdf5")
        with MechanicsHdf5Runner(io_filename=file, mode="w") as runner:
            scene(runner, grains, friction, width)
        with MechanicsHdf5Runner(io_filename=file, mode="r+") as runner:
            runner.run(
                T=(steps + 0.5) * TIMESTEP, h=TIMESTEP, theta=0.50001, Newton_max_iter=1,
                set_external_forces=weight, solver_options=options, bullet_options=bullet,
                verbose=False, verbose_progress=False, output_frequency=10**9,
                end_run_iteration_hook=look,
            )  # fmt: skip
    return last[0], np.diff(clocks)


def forces(rows: np.ndarray) -> np.ndarray:
    """Numbers of two grains and the force on the first, sorted."""
    pairs = rows[:, -2:].astype(int) - 1
    found = rows[:, FIRST_FORCE : FIRST_FORCE + 3] / TIMESTEP
    wall = pairs[:, 0] == pairs[:, 1]  # Siconos gives the grain twice
    turned = pairs[:, 0] > pairs[:, 1]
    found[turned] *= -1
    pairs.sort(axis=1)
    pairs[wall, 1] = -1
    out = np.column_stack([pairs, found])
    return out[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("grains")
    parser.add_argument("forces")
    parser.add_argument("friction", type=float)
    parser.add_argument("--steps", type=int, default=2)
    parser.add_argument("--tolerance", type=float, default=1e-10)
    parser.add_argument("--width", type=float, default=0.0)
    given = parser.parse_args()
    grains = np.load(given.grains)
    with contextlib.redirect_stdout(io.StringIO()):
        rows, took = run(grains, given.friction, given.width, given.steps, given.tolerance)
    np.save(given.forces, forces(rows))
    print(float(np.median(took)), len(rows))


if __name__ == "__main__":
    main()
