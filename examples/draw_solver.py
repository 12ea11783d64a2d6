"""Solvers of contact forces: what is left of the error after some sweeps, and which ones blow up.

python draw_solver.py        writes solver.png; half a minute
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import (
    Box,
    Case,
    GaussSeidel,
    Jacobi,
    Plates,
    RandomStart,
    RigidContact,
    RigidSpheres,
    Run,
    Simulation,
    SphereKind,
)
from mesokit.report.style import COLOURS, STYLE, lettered
from mesokit.theory import parallel_factor, sweep_error

TALL = 20  # grains of the column
SIDE = 8  # of the triangular packing
NOISE = 1e-10
STEP = 1e-4
LONG = (1, 2, 5, 10, 20, 50, 100, 200, 300, 400, 600)
SHORT = (1, 2, 3, 4, 6, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32)
SOLVERS = (
    ("random order", lambda n: GaussSeidel("random", sweeps=n, tolerance=0.0), LONG, "o"),
    ("ordered", lambda n: GaussSeidel("ordered", sweeps=n, tolerance=0.0), LONG, "s"),
    ("coloured", lambda n: GaussSeidel("coloured", sweeps=n, tolerance=0.0), LONG, "^"),
    ("all at once", lambda n: Jacobi(sweeps=n, tolerance=0.0), SHORT, "X"),
    ("all at once, relaxed by 0.6", lambda n: Jacobi(0.6, sweeps=n, tolerance=0.0), LONG, "v"),
)
THEORY = {"random order": "random", "ordered": "ordered", "coloured": "coloured",
          "all at once": "jacobi"}  # fmt: skip


def engine_of(size, places, solver, **more):
    """Grains of diameter and mass 1 without friction, at rest."""
    case = Case(
        run=Run(0, method="contact-dynamics", seed=1),
        box=Box(size),
        spheres=RigidSpheres(
            number=len(places),
            kinds=[SphereKind(1.0, spread=1e-14)],  # equal ones are refused if they overlap
            contact=RigidContact(friction=0.0),
            solver=solver,
            timestep=STEP,
            start=RandomStart(),  # whose places are given below
            **more.pop("spheres", {}),
        ),
        **more,
    )
    still = np.zeros_like(places)
    return Simulation(case, threads=1, positions=places, velocities=still).engine


def column(solver):
    """Error of the forces of a column, which bear (N - i) m g, over the root mean square force."""
    places = np.column_stack([np.full(TALL, 2.0), 0.5 + np.arange(TALL)])
    engine = engine_of([4, TALL + 2], places, solver, walls=[Plates("y")],
                       spheres={"gravity": [0, -1]})  # fmt: skip
    engine.advance(1)
    found = engine.contacts()
    forces = np.zeros(TALL)  # of the contact below each grain
    between = ~found.at_walls
    forces[found.pairs[between].max(axis=1)] = found.normal_forces[between]
    forces[found.pairs[found.at_walls, 0]] = found.normal_forces[found.at_walls]
    exact = TALL - np.arange(TALL)
    return float(np.sqrt(((forces - exact) ** 2).mean() / (exact**2).mean()))


def packing(solver):
    """What is left of the velocities of a packing under pressure, periodic, in a step.

    All contacts push with an impulse of 1, but for noise that sets the grains in motion.
    """
    squeeze, high = 1 - 1e-3, math.sqrt(3) / 2
    row, column = np.divmod(np.arange(SIDE * SIDE), SIDE)
    places = squeeze * np.column_stack([column + 0.5 * (row % 2) + 0.25, high * row + 0.25])
    engine = engine_of([squeeze * SIDE, squeeze * high * SIDE], places, solver)
    above, right = (row + 1) % SIDE * SIDE, (column + row % 2) % SIDE
    others = (row * SIDE + (column + 1) % SIDE, above + right, above + (right - 1) % SIDE)
    pairs = np.concatenate([np.column_stack([np.arange(SIDE * SIDE), o]) for o in others])
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    apart = engine.positions()[pairs[:, 0]] - engine.positions()[pairs[:, 1]]
    apart -= engine.box * np.rint(apart / engine.box)
    normals = apart / np.linalg.norm(apart, axis=1)[:, None]
    noise = NOISE * np.random.default_rng(1).normal(size=len(pairs))
    impulses = np.zeros((len(pairs), 3))  # of the last step, with which this one begins
    impulses[:, :2] = (1 + noise)[:, None] * normals
    engine.restore(engine.state() | {"pairs": pairs, "springs": impulses})
    first = np.zeros_like(places)
    np.add.at(first, pairs[:, 0], noise[:, None] * normals)
    np.add.at(first, pairs[:, 1], -noise[:, None] * normals)
    engine.advance(1)
    return float(np.linalg.norm(engine.velocities()) / np.linalg.norm(first))


def main():
    """Draw errors against sweeps, of a column and of a triangular packing."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
    for ax, error in zip(axes, (column, packing), strict=True):
        for (name, solver, sweeps, marker), hue in zip(SOLVERS, COLOURS, strict=False):
            if error is column and "relaxed" in name:
                continue
            sweeps = LONG if error is column else sweeps
            found = np.array([error(solver(n)) for n in sweeps])
            seen = found > 1e-13
            ax.plot(np.array(sweeps)[seen], found[seen], marker, mfc="white", color=hue,
                    label=name)  # fmt: skip
            print(f"{error.__name__}, {name}: {found[0]:.3g} after 1 sweep, {found[-1]:.3g} after "
                  f"{sweeps[-1]}")  # fmt: skip
            if error is column and name in THEORY:
                ratio = found[-2] / sweep_error(sweeps[-2], TALL, THEORY[name], column=True)
                print(f"  over theory: {ratio:.3f}")
            if error is packing and name == "all at once":
                growth = (found[-1] / found[-3]) ** (1 / (sweeps[-1] - sweeps[-3]))
                print(
                    f"  grows by {growth:.3f} in a sweep, theory {-parallel_factor('triangular')}"
                )
                late = np.arange(16, sweeps[-1] + 1)
                ax.plot(late, found[-1] * 2.0 ** (late - sweeps[-1]), color=hue, lw=1,
                        label="theory: doubles")  # fmt: skip
        ax.set(yscale="log", xlabel="sweeps over all contacts")
    every = np.geomspace(1, 600, 300)
    weight = math.sqrt(96) / math.pi**2  # of the slowest wave in the forces of no sweep
    for order, style in (("random", "-"), ("ordered", "--"), ("jacobi", ":")):
        law = weight * sweep_error(every, TALL, order, column=True)
        words = {"jacobi": "all at once"}.get(order, order)
        axes[0].plot(every, law, "k" + style, lw=1, label=f"theory: {words}")
    axes[0].set(ylabel="error of forces over the rms force", title=f"{TALL} grains in a column",
                ylim=(1e-2, 2))  # fmt: skip
    axes[1].set(xscale="log", ylabel="velocities over those of no sweep", ylim=(1e-5, 1e10),
                title=f"{SIDE * SIDE} grains in a triangular packing")  # fmt: skip
    axes[0].legend(loc="lower left", fontsize=8)
    axes[1].legend(fontsize=8)
    lettered(list(axes))
    figure.savefig("solver.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
