"""A chain of rigid grains that a plate pushes: how far the push has come, by the sweeps of a step.

python draw_chain.py        writes chain.png; some seconds
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import (
    Box,
    Case,
    GaussSeidel,
    Plates,
    RigidContact,
    RigidSpheres,
    Run,
    Simulation,
    SphereKind,
    Surface,
    SurfaceContact,
)
from mesokit.report.style import STYLE, lettered
from mesokit.theory import rigid_chain

GRAINS, SEEDS = 240, 4
SWEEPS = (5, 20, 100)  # of a step, whatever the error
SPEED = 1e-4  # of the plate, in diameters per step
STEP = 1.0


def pushed(sweeps, steps, seed):
    """Velocities (steps, grains) of a chain at rest that a plate begins to push, over its own."""
    plate = Surface(contact=SurfaceContact(speed=SPEED))
    case = Case(
        run=Run(0, method="contact-dynamics", seed=seed),
        box=Box([GRAINS + 10, 4]),
        walls=[Plates("x", lower=plate)],
        spheres=RigidSpheres(
            number=GRAINS,
            kinds=[SphereKind(1.0)],
            contact=RigidContact(friction=0.0),
            solver=GaussSeidel("random", sweeps=sweeps, tolerance=0.0),
            timestep=STEP,
        ),
    )
    places = np.column_stack([0.5 + np.arange(GRAINS), np.full(GRAINS, 2.0)])
    still = np.zeros((GRAINS, 2))
    engine = Simulation(case, threads=1, positions=places, velocities=still).engine
    found = []
    for _ in range(steps):
        engine.advance(1)
        found.append(engine.velocities()[:, 0] / SPEED)
    return np.array(found)


def front(velocities):
    """Place where the velocity is half that of the plate, step by step; nan before and after."""
    found = np.full(len(velocities), np.nan)
    for t, v in enumerate(velocities):
        slow = np.flatnonzero(v < 0.5)
        if len(slow) and slow[0] > 0:
            k = slow[0]
            found[t] = 0.5 + k - 1 + (v[k - 1] - 0.5) / (v[k - 1] - v[k])
    return found


def main():
    """Draw velocities in space and time, and the fronts beside theory."""
    figure, axes = plt.subplots(2, 2, figsize=(9, 7), layout="constrained")
    right, shown = axes[1, 1], None
    for ax, sweeps, style in zip(axes.flat, SWEEPS, ("o", "s", "^"), strict=False):
        law = rigid_chain(sweeps, STEP, 1.0, 1.0)
        steps = int(0.95 * GRAINS / law.speed)
        all_runs = np.array([pushed(sweeps, steps, seed) for seed in range(1, SEEDS + 1)])
        times = np.arange(1, steps + 1)
        shown = ax.pcolormesh(
            np.arange(GRAINS + 1), np.arange(steps + 1) + 0.5, all_runs[0], cmap="Greys",
            vmin=0, vmax=1, rasterized=True,
        )  # fmt: skip
        ax.plot(law.speed * times, times, "--", color="#d4552a", lw=1.5,
                label=f"$c = d\\sqrt{{q N_I}}/\\Delta t = {law.speed:.2f}$")  # fmt: skip
        ax.set(title=f"$N_I = {sweeps}$ sweeps in a step", xlabel="$x$  [$d$]",
               ylabel="time  [$\\Delta t$]", xlim=(0, GRAINS))  # fmt: skip
        ax.legend(loc="lower right")
        fronts = np.array([front(run) for run in all_runs])
        late = (times > 0.3 * steps) & (times < 0.8 * steps)
        speeds = [np.polyfit(times[late], line[late], 1)[0] for line in fronts]
        speed, error = np.mean(speeds), np.std(speeds, ddof=1) / np.sqrt(SEEDS)
        print(f"{sweeps} sweeps: front at {speed:.3f} +- {error:.3f} d/step, law {law.speed:.3f}")
        far = np.unique(np.linspace(1, 0.82 * steps, 14).astype(int))
        right.plot(times[far] * law.speed, fronts.mean(axis=0)[far], "k" + style, mfc="white",
                   label=f"$N_I = {sweeps}$: speed {speed:.2f}, law {law.speed:.2f}")  # fmt: skip
    figure.colorbar(shown, ax=list(axes.flat[:2]), label="velocity over that of the plate")
    right.plot([0, GRAINS], [0, GRAINS], color="0.6", label="theory: $x = c\\,t$")
    right.set(xlabel="$c\\,t$  [$d$]", ylabel="place of the front  [$d$]", xlim=(0, GRAINS),
              ylim=(0, GRAINS))  # fmt: skip
    right.legend()
    lettered(list(axes.flat))
    figure.savefig("chain.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
