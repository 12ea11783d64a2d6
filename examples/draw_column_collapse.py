"""Columns of disks that are let go: stills of one, and the run-out of four shapes beside a law.

python draw_column_collapse.py    runs column_collapse.toml with four columns, writes
                                  column_collapse.png; two minutes
"""

from dataclasses import replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from force_chains import draw_disks

from mesokit import Case, Rectangle, Simulation
from mesokit.report.style import STYLE, lettered
from mesokit.theory import run_out

CASE = Path(__file__).with_name("column_collapse.toml")
COLUMNS = ((20, 360), (14, 360), (11, 360), (8, 320))  # widths, and numbers of grains
SHOWN = 11
STILLS = (0, 4, 8, 35)  # since it was let go
WIDE, HIGH = 80, 36  # of a still
LATE = 0.8  # of the samples: the mean run-out is that of the rest


def column(width, number):
    """The case with a column of so many grains."""
    case = Case.from_toml(CASE)
    (long, high), gate = case.box.size, case.walls[-1]
    room = Rectangle([(long + 2 + width) / 2, high / 2], [long + 2 - width, high],
                     name=gate.name, opens=gate.opens)  # fmt: skip
    grains = replace(case.spheres, number=number)
    return replace(case, walls=[*case.walls[:-1], room], spheres=grains)


def main():
    """Let all columns go, and draw them."""
    figure = plt.figure(figsize=(9, 7.2), layout="constrained")
    parts = figure.subfigures(2, 1, height_ratios=(1.05, 1))
    stills = parts[0].subplots(2, 2, sharex=True, sharey=True).ravel()
    lengths, laws = parts[1].subplots(1, 2)
    found, shades = [], None
    for (width, number), style in zip(COLUMNS, ("-", "--", "-.", ":"), strict=True):
        case = column(width, number)
        simulation = Simulation(case, threads=1)
        engine = simulation.engine
        for ax, time in zip(stills, STILLS, strict=True) if width == SHOWN else ():
            now = round((case.walls[-1].opens + time) / engine.timestep)
            simulation.run(now - simulation.step)
            if shades is None:  # layers of the column at rest
                layer = np.argsort(np.argsort(engine.positions()[:, 1])) * 6 // engine.n % 2
                shades = np.where(layer == 0, "0.4", "0.85")
            draw_disks(ax, engine, shades)
            ax.set(xlim=(0, WIDE), ylim=(0, HIGH), aspect="equal")
            ax.set_title(rf"$t = {time}\,\sqrt{{d/g}}$", fontsize=10, loc="left")
        simulation.run()
        result = simulation["run-out"]
        numbers = {c.what: float(c.measured) for c in result.comparisons}
        ratio = numbers["aspect ratio of the column"]
        length, time = result.value[:, 0], result.x["time"]
        run = float(np.mean(length[round(LATE * len(length)) :]) / length[0] - 1)
        found.append((ratio, run))
        lengths.plot(time - time[0], length / length[0] - 1, "k" + style, lw=1.2,
                     label=f"$a = {ratio:.1f}$")  # fmt: skip
        law = float(run_out(ratio))
        print(f"width {width}: a = {ratio:.2f}, run-out {run:.2f}, law {law:.2f}")
    for ax in stills[-2:]:
        ax.set_xlabel("$x$  [$d$]")
    for ax in stills[::2]:
        ax.set_ylabel("$y$  [$d$]")
    lengths.set(xlabel="time  [$\\sqrt{d/g}$]", ylabel="run-out $(L - L_0)/L_0$", xlim=(0, None),
                ylim=(0, None))  # fmt: skip
    lengths.legend(ncols=2)
    line = np.geomspace(0.4, 12, 100)
    laws.plot(*np.transpose(found), "ko", mfc="white", label="measured, one column each")
    laws.plot(line, run_out(line), color="0.5", label="Staron and Hinch 2005")
    laws.fill_between(line, 0.75 * run_out(line), 1.25 * run_out(line), color="0.9",
                      label="$\\pm$ 25 %")  # fmt: skip
    laws.set(xscale="log", yscale="log", xlabel="aspect ratio $a = H_0/L_0$",
             ylabel="run-out $(L - L_0)/L_0$")  # fmt: skip
    laws.legend()
    lettered([*stills, lengths, laws])
    figure.savefig("column_collapse.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
