"""The clock of kinetic Monte Carlo: a walk with rates 1.5 to the right and 0.5 to the left.

python draw_clock.py      prints both drifts and writes clock.png; some seconds

The wait for the next event is -ln(u)/K with the rate K of all that may happen. With the rate of the
event that was chosen in its place the drift is 0.5, not 1.
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import Box, Run, Simulation
from mesokit.method.kinetic_monte_carlo.model.wells import Link, Well, Wells
from mesokit.method.kinetic_monte_carlo.section import Lattice
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from mesokit.report.style import COLOURS, STYLE, lettered

RIGHT, LEFT = 1.5, 0.5  # rates of a hop
WALKERS, TIME, SLICES, SHOWN = 2000, 40.0, 400, 8
RING = 100  # wells in a row that closes: what matters is where a walker has gone to on it


def right_clock():
    """Times, and places (times, walkers), by mesokit."""
    hops = [(k, (k + 1) % RING) for k in range(RING)]
    links = [Link(hop=f"{a} -> {b}", rate=RIGHT) for a, b in hops]
    links += [Link(hop=f"{b} -> {a}", rate=LEFT) for a, b in hops]
    model = Wells(well=[Well(name=str(k)) for k in range(RING)], link=links)
    lattice = Lattice(kind="chain", model=model, timestep=TIME / SLICES, start=UniformStart())
    run = Run(steps=SLICES, method="kinetic-monte-carlo")
    engine = Simulation(run=run, box=Box([WALKERS]), lattice=lattice).engine
    places = [np.zeros(WALKERS)]
    for _ in range(SLICES):
        before = engine.sites().astype(int)
        engine.advance(1)
        places.append(places[-1] + (engine.sites() - before + RING // 2) % RING - RING // 2)
    return np.linspace(0, TIME, SLICES + 1), np.array(places)


def wrong_clock(times):
    """Places at these times, where each wait is that of the chosen event."""
    random, found = np.random.default_rng(1), np.zeros((len(times), WALKERS))
    for walker in range(WALKERS):
        to_right = random.random(int(8 * TIME)) < RIGHT / (RIGHT + LEFT)
        wait = -np.log(1 - random.random(len(to_right))) / np.where(to_right, RIGHT, LEFT)
        steps = np.cumsum(np.where(to_right, 1, -1))
        place = np.concatenate([[0], steps])
        found[:, walker] = place[np.searchsorted(np.cumsum(wait), times, side="right")]
    return found


def main():
    """Walk by both clocks."""
    times, right = right_clock()
    both = {"-\\ln u/K": right, "-\\ln u/k_i": wrong_clock(times)}
    drift, late = RIGHT - LEFT, times > 0.25 * TIME  # the wrong clock takes a while to be steady
    figure, panels = plt.subplots(1, 2, figsize=(7.5, 3.2), layout="constrained", sharey=True)
    for ax, (clock, places), name in zip(panels, both.items(), ("right", "wrong"), strict=True):
        first, last = places[late][0], places[-1]
        each = (last - first) / (times[-1] - times[late][0])
        error = each.std() / math.sqrt(WALKERS)
        print(f"{name} clock: drift {each.mean():.3f} +- {error:.3f}, expected {drift:.3f}")
        ax.plot(times, places[:, :SHOWN], color=COLOURS[0], lw=0.6, drawstyle="steps-post")
        ax.plot([], [], color=COLOURS[0], lw=0.6, label=f"{SHOWN} walkers")
        ax.plot(times, places.mean(axis=1), color=COLOURS[1], lw=2.5, label=f"mean of {WALKERS}")
        ax.plot(times, drift * times, "k--", lw=1.2, label="theory: $(1.5 - 0.5)\\,t$")
        ax.set(title=f"{name}: $dt = {clock}$", xlabel="time $t$", ylim=(-5, 1.5 * TIME))
        ax.legend(loc="upper left", fontsize=8)
    panels[0].set_ylabel("place of a walker, in wells")
    lettered(panels)
    figure.savefig("clock.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
