"""Whether error bars are the scatter of seeds: every observable of every method.

Usage: python validation/error_bars.py [methods...] [--short]

Runs that are done stay in build/validation, as do those of other pages, so a stop costs one run;
`make clean` makes them begin anew. The page is written when all methods are asked for.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from common import ROOT, RUNS, SHORT, Page, sources

from mesokit import Case, Simulation
from mesokit.case.checks import is_offered
from mesokit.case.methods import templates
from mesokit.case.toml import override, parse, read
from mesokit.errors import CaseError
from mesokit.method.mpcd.observe import OBSERVABLES as OF_MPCD
from mesokit.method.spheres.common.observe import OBSERVABLES as OF_SPHERES
from mesokit.method.spheres.hard.observe import OBSERVABLES as OF_HARD_SPHERES
from mesokit.method.spheres.soft.observe import OBSERVABLES as OF_SOFT_SPHERES
from mesokit.observe import OBSERVABLES as OF_SEVERAL
from mesokit.seam.method import method_of
from mesokit.seam.observable import Observable
from mesokit.statistics import spread_ids

SEEDS = 4 if SHORT else 16
MOST = 200  # values of a curve or map that are looked at
LEAST, LARGEST = 0.85, 1.15  # asked of a method in the mean


class Scene(NamedTuple):
    """A short case of a method: a template or example, what differs in it, and how often all
    observables look. given: by the name of an observable, what it asks for beyond that."""

    name: str
    method: str
    file: Path
    set: dict[str, Any]
    every: int = 5
    given: Mapping[str, Mapping[str, Any]] = MappingProxyType({})


def template(method: str, name: str = "") -> Path:
    """The file of a template, which has the method's name unless said."""
    return Path(str(templates()[name or method.replace("-", "_")]))


SCENES = (
    Scene(
        "brownian particles", "brownian", template("brownian"),
        {"run.steps": 1000, "box.size": [9, 9, 9]},
    ),
    Scene(
        "brownian particles in 2D", "brownian", template("brownian"),
        {"run.steps": 1500, "box.size": [14, 12]},
    ),
    Scene(
        "an ordered flock", "flock", template("flock"),
        {"run.steps": 6000, "box.size": [10, 10], "flock.density": 1}, 20,
    ),
    Scene(
        "a disordered flock", "flock", template("flock"),
        {"run.steps": 6000, "box.size": [10, 10], "flock.density": 1, "flock.noise.strength": 4.5},
        20,
    ),
    Scene(
        "hard disks", "event-driven", template("event-driven", "event_driven"),
        {"run.steps": 800, "run.warmup": 50, "box.size": [14, 14]}, 2,
    ),
    Scene(
        "hard spheres", "event-driven", template("event-driven", "event_driven"),
        {
            "run.steps": 800, "run.warmup": 50, "box.size": [6, 6, 6],
            "spheres.packing_fraction": 0.2,
        }, 2,
    ),
    Scene(
        "hard disks in gravity", "event-driven", template("event-driven", "event_driven"),
        {
            "run.steps": 4000, "run.warmup": 200, "box.size": [10, 12],
            "spheres.packing_fraction": 0.2, "spheres.gravity": [0, -0.3],
            "spheres.heating": {"rule": "andersen"},  # else each seed keeps the energy of its start
            "wall": [{"shape": "plates", "axis": "y"}],
        }, 4,
    ),
    Scene(
        "a Lennard-Jones fluid in a bath", "soft-spheres", ROOT / "examples" / "lennard_jones.toml",
        {
            "run.steps": 12000, "run.warmup": 2000, "box.size": [5.9, 5.9, 5.9],
            "spheres.number": 120, "spheres.kT": 1.5, "spheres.thermostat.kT": 1.5,
        }, 10,
    ),
    Scene(
        "a simple fluid", "mpcd", template("mpcd", "bulk"),
        {
            "run.steps": 2000, "run.warmup": 100, "box.size": [6, 6, 6],
            "fluid.thermostat": {"rule": "maxwell-boltzmann"},  # else each seed keeps its energy
        },
    ),
    Scene(
        "a channel", "mpcd", template("mpcd", "poiseuille"),
        {"run.steps": 6000, "run.warmup": 1500, "box.size": [16, 12]}, 10,
    ),
    Scene(
        "a flow past a disk", "mpcd", template("mpcd", "obstacle"),
        {
            "run.steps": 16000, "run.warmup": 2000, "box.size": [14, 14],
            "fluid.force.acceleration": [0.008, 0],
            "wall": [{"shape": "disk", "centre": [7, 7], "radius": 3}],
        }, 10, {"Forces": {"length": 6.0}},
    ),
    Scene(
        "a shear", "mpcd", template("mpcd", "shear"),
        {"run.steps": 2000, "run.warmup": 200, "box.size": [6, 6, 6]},
    ),
    Scene(
        "dimers", "mpcd", ROOT / "examples" / "dimers.toml",
        {"run.steps": 4000, "run.warmup": 200, "box.size": [7, 7, 7]}, 10,
    ),
    Scene(
        "chains in a random solvent", "mpcd", ROOT / "examples" / "pulled_chains.toml",
        {
            "run.steps": 20000, "run.warmup": 1000, "box.size": [30, 30], "solutes.pulls": [],
            "solutes.solvent": "random", "solutes.polymers": [{"number": 20, "length": 8}],
        }, 20,
    ),
)  # fmt: skip


def case_of(scene: Scene, seed: int) -> Case:
    """The case with every observable that it can have."""
    data = parse(read(scene.file))
    for section in ("observe", "trajectory", "log"):
        data.pop(section, None)
    for key, value in (scene.set | {"run.seed": seed}).items():
        override(data, key, value)
    plain, accepted = Case.from_data(data, scene.file.parent), []
    method = method_of(plain)
    bases = [base for base in method.observables if base is not Observable]
    own = [kind for base in bases for kind in base.__subclasses__()]
    for kind in (*OF_SEVERAL, *OF_MPCD, *OF_SPHERES, *OF_HARD_SPHERES, *OF_SOFT_SPHERES, *own):
        if not is_offered(kind, method.name, method.observables):
            continue
        try:
            observable = kind(every=scene.every, **scene.given.get(kind.__name__, {}))
            dataclasses.replace(plain, observe=[*accepted, observable])
        except (CaseError, TypeError):
            continue  # not in this case, or not without more being said
        accepted.append(observable)
    return dataclasses.replace(plain, observe=accepted)


def measured(page: Page, scene: Scene, seed: int) -> dict[str, Any]:
    """Numbers and values with their errors, by observable; kept from an earlier call."""
    case, began = case_of(scene, seed), time.perf_counter()
    mark = hashlib.sha256(case.to_toml(ROOT).encode()).hexdigest()[:16]
    file = RUNS / ("short" if SHORT else "") / "error_bars" / f"{mark}.json"
    if file.exists():
        known = json.loads(file.read_text())
        page.sources.add(known["sources"])
        page.kept += known["seconds"]
        return known["found"]
    simulation = Simulation(case, threads=1)
    simulation.run()
    found: dict[str, Any] = {}
    for observable in case.observe:
        result = simulation[observable.label]
        some = spread_ids(MOST, np.size(result.value))
        found[observable.label] = {
            "numbers": {
                c.key: (c.measured, c.error, "lower bound" in c.note) for c in result.comparisons
            },
            "value": np.ravel(result.value)[some].tolist(),
            "error": np.ravel(result.error)[some].tolist(),
        }
    file.parent.mkdir(parents=True, exist_ok=True)
    known = {"sources": sources(), "seconds": time.perf_counter() - began, "found": found}
    file.write_text(json.dumps(known))
    page.sources.add(known["sources"])
    return found


def root(values: Any, errors: Any) -> Any:
    """Scatter of the seeds (seeds, ...) over what they quote: nan where either is 0 or unknown."""
    values, errors = np.asarray(values, float), np.asarray(errors, float)
    with np.errstate(divide="ignore", invalid="ignore"):
        quoted = np.sqrt((errors**2).mean(axis=0))
        scatter = values.std(axis=0, ddof=1)
        exact = quoted <= 1e-12 * np.maximum(abs(values).max(axis=0), 1.0)  # rounding
        return np.where(exact, np.nan, scatter / quoted)


class Row(NamedTuple):
    """A number, or the curve of an observable: root of the mean chi-square, of how many values,
    and whether the error bar is said to be a lower bound."""

    scene: str
    observable: str
    number: str
    root: float
    values: int
    bound: bool


def rows_of(scene: Scene, runs: list[dict[str, Any]]) -> list[Row]:
    """What is to be told of a scene."""
    rows = []
    for label in runs[0]:
        per_seed = [run[label] for run in runs]
        if len({len(one["value"]) for one in per_seed}) == 1:
            curve = root([one["value"] for one in per_seed], [one["error"] for one in per_seed])
            known = curve[np.isfinite(curve)]
            if len(known):
                mean = float(np.sqrt(np.mean(known**2)))
                rows.append(Row(scene.name, label, "all values", mean, len(known), False))
        for key in per_seed[0]["numbers"]:
            if not all(key in one["numbers"] for one in per_seed):
                continue
            value, error, bound = zip(*(one["numbers"][key] for one in per_seed), strict=True)
            if np.isfinite(found := float(root(value, error))):
                rows.append(Row(scene.name, label, key, found, 1, 2 * sum(bound) > SEEDS))
    return rows


def make(methods: list[str] | None = None) -> int:
    """Write the page, or print what is found of some methods."""
    page = Page("error_bars", "Error bars and the scatter of seeds")
    page.text(
        f"Short cases with {SEEDS} seeds. Of every number and every value of a curve: the scatter "
        "of the seeds over the root mean square of the error bars that the runs quote, 1 where "
        f"error bars are right. The scatter of {SEEDS} seeds is itself known to "
        f"{100 / np.sqrt(2 * (SEEDS - 1)):.0f} %. A curve has the root of the mean square over its "
        "values, a method that over its numbers and curves. Numbers whose error bar most runs call "
        "a lower bound do not count in it. In 2D the error bar of D holds its growth over a decade "
        "of lags."
    )
    known = {scene.method for scene in SCENES}
    if unknown := set(methods or ()) - known:
        print(f"unknown: {', '.join(sorted(unknown))}; there are {', '.join(sorted(known))}")
        return 2
    outside, spread = [], 1 / np.sqrt(2 * (SEEDS - 1))
    for method in dict.fromkeys(scene.method for scene in SCENES):
        if methods and method not in methods:
            continue
        page.heading(method)
        rows: list[Row] = []
        for scene in (scene for scene in SCENES if scene.method == method):
            print(f"  {scene.name}", flush=True)
            rows += rows_of(scene, [measured(page, scene, seed) for seed in range(1, SEEDS + 1)])
        page.grid(["case", "observable", "number", "values", "root of chi-square"], [
            [row.scene, row.observable, row.number, row.values,
             f"{row.root:.2f}" + " (lower bound)" * row.bound] for row in rows
        ])  # fmt: skip
        counted = np.array([row.root for row in rows if not row.bound])
        mean = float(np.sqrt(np.mean(counted**2)))
        page.check(f"{method}: {mean:.2f} ({LEAST} to {LARGEST})", LEAST <= mean <= LARGEST)
        outside += [
            row for row in rows
            if not LEAST / (1 + 2 * spread) < row.root < LARGEST * (1 + 2 * spread)
        ]  # fmt: skip
    page.heading("Outside")
    page.text(
        f"Those below {LEAST / (1 + 2 * spread):.2f} or above {LARGEST * (1 + 2 * spread):.2f}, "
        "two standard errors of a root beyond what is asked for."
    )
    page.grid(["case", "observable", "number", "root of chi-square"], [
        [row.scene, row.observable, row.number, f"{row.root:.2f}"] for row in outside
    ])  # fmt: skip
    return sum(not met for _, met in page.checks) if methods else page.write()


if __name__ == "__main__":
    sys.exit(1 if make([name for name in sys.argv[1:] if not name.startswith("-")]) else 0)
