"""Two soft grains that collide: overlap and force in time, of linear and of Hertz springs.

python draw_two_grains.py        writes two_grains.png; some seconds
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

from mesokit import Box, Case, HertzLaw, Run, Simulation, SoftSpheres, SpringDashpot, theory
from mesokit.report.style import STYLE, lettered

K, SPEED, MASS = 1e4, 1.0, 0.5  # stiffness, closing speed, reduced mass of two grains of mass 1
DAMPING = 40.0
STEPS = 200  # in a contact
LAWS = {
    "linear spring": SpringDashpot(stiffness=K, damping=0.0),
    "linear spring and dashpot": SpringDashpot(stiffness=K, damping=DAMPING),
    "the same, cut off where it would pull": SpringDashpot(
        stiffness=K, damping=DAMPING, pulls=False
    ),
    "Hertz": HertzLaw(stiffness=K),
}


def collide(law):
    """Times since the first touch, overlaps and forces, and the restitution: two grains that meet
    head on, looked at in every step."""
    step = law.contact_time_of(MASS, SPEED) / STEPS
    case = Case(
        run=Run(0, method="soft-spheres"),
        box=Box([6, 6]),
        spheres=SoftSpheres(number=2, pair=law, timestep=step),
    )
    apart = 1 + 0.5 * SPEED * step  # they touch in the middle of the first step
    engine = Simulation(
        case,
        positions=[[3 - apart / 2, 3], [3 + apart / 2, 3]],
        velocities=[[SPEED / 2, 0], [-SPEED / 2, 0]],
    ).engine
    rows = []
    for _ in range(int(1.4 * STEPS)):
        engine.advance(1)
        x = engine.positions()[:, 0]
        rows.append((engine.time - 0.5 * step, 1 - (x[1] - x[0]), -engine.forces()[0, 0]))
    v = engine.velocities()[:, 0]
    return np.array(rows).T, (v[1] - v[0]) / SPEED


def motion(law, times):
    """Overlap and force of theory, until the contact ends; and how long it lasts."""
    end = law.contact_time_of(MASS, SPEED)
    inside = times[(times >= 0) & (times <= end)]
    if isinstance(law, HertzLaw):  # no closed form: m x'' = -k x^(3/2)

        def fall(_, state):
            return [state[1], -K * max(state[0], 0.0) ** 1.5 / MASS]

        x, _ = solve_ivp(fall, (0, end), [0, SPEED], t_eval=inside, rtol=1e-10, atol=1e-14).y
        return inside, x, K * np.maximum(x, 0) ** 1.5, end
    b = 0.5 * law.damping / MASS
    w = np.sqrt(K / MASS - b * b)
    x = SPEED / w * np.exp(-b * inside) * np.sin(w * inside)
    rate = SPEED / w * np.exp(-b * inside) * (w * np.cos(w * inside) - b * np.sin(w * inside))
    return inside, x, K * x + law.damping * rate, end


def expected(law):
    """Restitution and duration, and the largest overlap where theory has it."""
    if isinstance(law, HertzLaw):
        return 1.0, *theory.hertz_contact(K, MASS, SPEED)[::-1]
    e, time = theory.spring_dashpot(K, law.damping, MASS, law.pulls)
    return e, time, SPEED * np.sqrt(MASS / K) if law.damping == 0 else np.nan


def main():
    """Draw overlaps, forces, and forces against overlaps."""
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.8), layout="constrained")
    looks = {"lw": 1.2, "color": "black"}
    for (name, law), style in zip(LAWS.items(), ("-", "--", ":", "-."), strict=True):
        (time, overlap, force), restitution = collide(law)
        e, duration, deepest = expected(law)
        t, x, f, _ = motion(law, np.linspace(0, 2 * duration, 1000))
        touching = overlap > 0 if law.pulls else force > 0
        print(
            f"{name}: restitution {restitution:.5f} (theory {e:.5f}), "
            f"contact {touching.sum() * (time[1] - time[0]):.5f} ({duration:.5f}), "
            f"largest overlap {overlap.max():.6f} ({deepest:.6f})"
        )
        for ax, data, law_of in (
            (axes[0], (time, 1e3 * overlap), (t, 1e3 * x)),
            (axes[1], (time, force), (t, f)),
            (axes[2], (1e3 * overlap, force), (1e3 * x, f)),
        ):
            ax.plot(*law_of, color="0.75", lw=4, zorder=1)
            shown = touching | (overlap > 0)
            ax.plot(data[0][shown], data[1][shown], style, label=name, zorder=2, **looks)
    axes[0].plot([], [], color="0.75", lw=4, label="theory")
    time = "time since the first touch"
    axes[0].set(xlabel=time, ylabel=r"overlap $x$  [$10^{-3}\,d$]", xlim=(0, None))
    axes[1].set(xlabel=time, ylabel="force $F$  [$m\\,a/\\tau^2$]", xlim=(0, None))
    axes[2].set(xlabel=r"overlap $x$  [$10^{-3}\,d$]", ylabel="force $F$  [$m\\,a/\\tau^2$]")
    for ax in axes:
        ax.axhline(0, color="black", lw=0.6)
    axes[0].set_xlabel(time + r"  [$\tau$]")
    axes[1].set_xlabel(time + r"  [$\tau$]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    lettered(axes)
    figure.savefig("two_grains.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
