"""What the validation scripts share: numbers next to theory, and the page that shows them."""

from __future__ import annotations

import hashlib
import json
import math
import platform
import shutil
import sys
import time
from datetime import date
from pathlib import Path
from typing import Any

import matplotlib
import numba
import numpy as np

import mesokit
from mesokit import Comparison
from mesokit.report.style import COLOURS, STYLE, lettered

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "validation"
RUNS = ROOT / "build" / "validation"  # runs that `kept` keeps
SHORT = "--short" in sys.argv  # a quick try: a fiftieth of the steps, nothing is written to docs
ANGLE = math.degrees(2.27)  # the angle at which the 3D viscosity is quoted in the literature
BLUE, RED, GREEN, PURPLE, _, GREY = COLOURS

UNITS = {  # of labels that are only words
    ("time",): r"\tau",
    ("x", "y", "r", "place within the cell", "distance from the surface", "slip length"): "a",
    ("bond length, K = 1",): "a",
    ("velocity", "velocity along the pipe", "azimuthal velocity"): r"a/\tau",
    ("velocity - linear", "velocity - line"): r"a/\tau",
    ("shear rate",): r"\tau^{-1}",
    ("viscosity",): r"a^2/\tau",
    ("temperature",): r"kT",
    ("K for a bond length of 2", "K"): "kT/a^2",
}

plt.rcParams.update(STYLE | {"savefig.dpi": 150})


def sources() -> str:
    """A digest of the package's sources, so that a page says which code it judges."""
    package = Path(mesokit.__file__).parent
    digest = hashlib.sha256()
    for file in sorted(package.rglob("*.py")):
        digest.update(str(file.relative_to(package)).encode() + file.read_bytes())
    return digest.hexdigest()[:12]


class Page:
    """A page of docs/validation: text, tables, figures, and what had to be shown."""

    def __init__(
        self, name: str, title: str, units: str = "cell side a, kT and particle mass are 1"
    ) -> None:
        self.name, self.title, self.units = name, title, units
        self.parts: list[str] = []
        self.checks: list[tuple[str, bool]] = []
        self.began = time.perf_counter()
        self.kept = 0.0  # seconds of runs that `kept` has read
        self.sources: set[str] = set()  # of those

    def text(self, text: str) -> None:
        """A paragraph."""
        self.parts.append(" ".join(text.split()) + "\n")

    def heading(self, text: str) -> None:
        """A heading."""
        self.parts.append(f"## {text}\n")

    def table(self, rows: list[Comparison]) -> None:
        """Measured against theory."""
        lines = ["| quantity | measured | standard error | theory | deviation | in s.e. | note |"]
        lines.append("|---|---|---|---|---|---|---|")
        for c in rows:
            error, digits = c.error, decimals(c.error, c.measured)
            percent = f"{c.percent:+.2f} %" if math.isfinite(c.percent) else ""
            what = c.what.replace("|", "\\|")
            lines.append(
                f"| {what} | {c.measured:.{digits}f} {c.unit} | {error:.{digits}f} | "
                + (f"{c.expected:.{digits}f}" if math.isfinite(c.expected) else "")
                + f" | {percent} | "
                + (f"{c.deviation:+.1f}" if math.isfinite(c.deviation) else "")
                + f" | {c.note} |"
            )
        self.parts.append("\n".join(lines) + "\n")
        print("\n".join(f"  {c}" for c in rows), flush=True)

    def grid(self, head: list[str], rows: list[list[Any]]) -> None:
        """Any other table."""
        lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
        lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
        self.parts.append("\n".join(lines) + "\n")
        print("\n".join(lines), flush=True)

    def figure(self, fig: Any, caption: str, suffix: str = "") -> None:
        """Save a figure beside the page, and show it there."""
        folder = place()
        file = f"{self.name}{suffix}.png"
        finish(fig)
        fig.tight_layout()
        fig.savefig(folder / file)
        plt.close(fig)
        caption = " ".join(caption.split())
        self.parts.append(f"![{caption}]({file})\n\n*{caption}*\n")

    def check(self, what: str, met: bool) -> None:
        """Something that had to be shown, and whether it was."""
        self.checks.append((what, bool(met)))
        print(f"  {'met' if met else 'NOT MET'}: {what}", flush=True)

    def run(
        self, name: str, case: mesokit.Case, positions: Any = None, velocities: Any = None
    ) -> mesokit.run.opened.RunFiles:
        """Run a case on one thread, or read the same run from build/validation if it is there.

        Long scripts can be stopped and go on; `make clean` makes them begin anew.
        """
        folder = RUNS / ("short" if SHORT else "") / self.name / name
        record, asked = folder / "sources.json", folder / "asked.toml"
        same = asked.exists() and asked.read_text() == case.to_toml()
        if not (same and record.exists()):
            print(f"  running {name}: {case.particles} particles", flush=True)
            begun = time.perf_counter()
            if same and (folder / "checkpoint.npz").exists():
                simulation = mesokit.Simulation.resume(folder, threads=1)
            else:
                shutil.rmtree(folder, ignore_errors=True)
                simulation = mesokit.Simulation(
                    case, output=folder, threads=1, positions=positions, velocities=velocities
                )
                asked.write_text(case.to_toml())
            simulation.run()
            (folder / "checkpoint.npz").unlink(missing_ok=True)  # large
            seconds = time.perf_counter() - begun
            record.write_text(json.dumps({"sources": sources(), "seconds": seconds}))
            self.began += seconds
        known = json.loads(record.read_text())
        self.kept += known["seconds"]
        self.sources.add(known["sources"])
        return mesokit.open(folder)

    def write(self) -> int:
        """Write the page; returns how many requirements were not met."""
        seconds = time.perf_counter() - self.began + self.kept
        digests = ", ".join(sorted(self.sources)) or sources()
        versions = f"mesokit {mesokit.__version__} (sources {digests})"
        versions += f", Python {platform.python_version()}"
        versions += f", NumPy {np.__version__}, Numba {numba.__version__}"
        head = [
            f"# {self.title}\n",
            f"Made by `python validation/{self.name}.py` on {date.today()} in {seconds:.0f} s, "
            f"one thread; {versions}. Units: {self.units}. Errors are one standard error.\n",
        ]
        marks = [f"- {'met' if met else '**not met**'}: {what}" for what, met in self.checks]
        if marks:
            head.append("\n".join(marks) + "\n")
        (place() / f"{self.name}.md").write_text("\n".join(head + self.parts), encoding="utf-8")
        return sum(not met for _, met in self.checks)


def finish(fig: Any) -> None:
    """Letters for panels, and units for labels."""
    panels = [ax for ax in fig.axes if ax.axison and not hasattr(ax, "_colorbar")]
    lettered(panels)
    for ax in panels:
        for axis in (ax.xaxis, ax.yaxis):
            label = axis.get_label().get_text()
            unit = next((u for words, u in UNITS.items() if label in words), "")
            if unit:
                axis.set_label_text(f"{label}  [${unit}$]")


def place() -> Path:
    """Where pages and figures go."""
    folder = RUNS / "short" if SHORT else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def long(steps: float) -> int:
    """So many steps, or few for a quick try."""
    return max(int(steps / (50 if SHORT else 1)), 100)


def decimals(error: float, value: float) -> int:
    """Decimals that show two digits of an error (four digits of a value without one)."""
    scale = error / 10 if error > 0 and math.isfinite(error) else abs(value) / 1000
    return max(0, -math.floor(math.log10(scale))) if scale > 0 else 3


def mean_and_error(values: Any) -> tuple[Any, Any]:
    """Mean of independent repetitions (along the first axis), and its standard error."""
    values = np.asarray(values, float)
    return values.mean(axis=0), values.std(axis=0, ddof=1) / math.sqrt(len(values))


def simulate(**parts: Any) -> mesokit.Simulation:
    """Run a case to its end on one thread."""
    simulation = mesokit.Simulation(threads=1, **parts)
    simulation.run()
    return simulation


def found(result: mesokit.Result, what: str) -> Comparison:
    """The comparison of a result that starts with `what`."""
    return next(c for c in result.comparisons if c.what.startswith(what))


def renamed(c: Comparison, what: str, note: str = "", expected: float | None = None) -> Comparison:
    """The same numbers under another name."""
    return Comparison(
        what, c.measured, c.error, c.expected if expected is None else expected, c.unit, note
    )


def main(make: Any) -> None:
    """Run a script: exit status 1 if something was not met."""
    sys.exit(1 if make() else 0)
