"""A column of soft grains at rest: what each contact bears.

python draw_column.py        runs column.toml and writes column.png; some seconds
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

from mesokit import Case, Simulation
from mesokit.report.style import STYLE, lettered

CASE = Path(__file__).with_name("column.toml")


def main():
    """Draw the column, and the forces of its contacts beside the weights above them."""
    case = Case.from_toml(CASE)
    engine = Simulation(case).engine
    engine.advance(case.run.warmup)
    n, law = case.spheres.number, case.spheres.pair
    y = np.sort(engine.positions()[:, 1])
    (mass, *_), g = engine.masses(), -case.spheres.gravity[1]
    between, _ = law.constants(mass / 2)  # stiffness of two grains, and of a grain on the floor
    below, _ = law.constants(mass)
    forces = np.array([below * (0.5 - y[0]), *(between * (1 - np.diff(y)))])
    number = np.arange(n)  # contact i is below grain i + 1: contact 0 is that with the floor
    weights = (n - number) * mass * g
    print(f"contacts bear {forces[0]:.4f} to {forces[-1]:.4f}; {n} grains weigh {weights[0]:.4f}")
    print(f"largest difference from (N - i) m g: {np.abs(forces / weights - 1).max():.1e}")

    figure, (left, right) = plt.subplots(
        1, 2, figsize=(6.5, 5), layout="constrained", width_ratios=(1, 4), sharey=True
    )
    places = [(0.5 * case.box.size[0], height) for height in y]
    left.add_collection(
        PatchCollection([Circle(r, 0.5) for r in places], facecolors="0.8", edgecolors="black")
    )
    heights = np.array([0.0, *(0.5 * (y[1:] + y[:-1]))])
    for height, force in zip(heights, forces, strict=True):  # as wide as the force is large
        left.plot([places[0][0]] * 2, [height - 0.3, height + 0.3], "k-", lw=force / forces[0] * 6)
    left.set(aspect="equal", xlim=(0, case.box.size[0]), ylabel="height  [$d$]", xticks=[])
    right.plot(weights, heights, color="0.7", lw=3, label="theory: $(N - i)\\,m g$")
    right.plot(forces, heights, "ko", mfc="white", ms=5, label="measured")
    right.set(xlabel="force of a contact  [$m\\,a/\\tau^2$]", xlim=(0, None), ylim=(-0.6, n + 0.6))
    right.legend()
    lettered([left, right])
    figure.savefig("column.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
