"""What the pages of bodies that move share: the fluid, the box, runs, and what is met."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from common import RUNS, SHORT, Page, sources

from mesokit import (
    SRD,
    ATPlusA,
    BodyMotion,
    Box,
    Case,
    Comparison,
    DiskBody,
    Fluid,
    GapPotential,
    MaxwellBoltzmann,
    Rectangle,
    Run,
    Simulation,
    Sphere,
    SphereBody,
    SpheroidBody,
    SRDPlusA,
    UnionBody,
    every,
    theory,
)

DENSITY, STEP = 10, 0.1
RULES: dict[str, tuple[Any, Any]] = {
    "at+a": (ATPlusA(), None),
    "srd+a": (SRDPlusA(angle=90), MaxwellBoltzmann()),
    "srd": (SRD(angle=130), MaxwellBoltzmann()),
}
# Kinematic, measured under shear (viscosity_rules.py), with standard errors. Theory of bodies has
# those of molecular chaos, as the program does.
VISCOSITIES = {
    ("at+a", 2): (0.4334, 0.0033), ("srd+a", 2): (0.3929, 0.0024), ("at+a", 3): (0.4066, 0.0029),
    ("srd", 3): (0.8748, 0.0064), ("srd+a", 3): (0.2958, 0.0012),  # the last: bodies_in_flow.py
}  # fmt: skip
PLATES = {2: 0.220, 3: 0.151}  # slip lengths of plates in SRD, mean free path 0.1
SLIP = {  # slip lengths that rotation gives on the page of bodies in flow; of plates for SRD
    ("at+a", 2): 0.070, ("srd+a", 2): 0.080, ("at+a", 3): 0.054, ("srd+a", 3): 0.037,
    ("srd", 3): 0.151,
}  # fmt: skip
DUMBBELL = (Sphere(centre=(-1.6, 0, 0), radius=1.7), Sphere(centre=(1.4, 0, 0), radius=1.3))
L_SHAPE = (Rectangle(centre=(0, 0), size=(6, 2)), Rectangle(centre=(2, 2.5), size=(2, 3)))
WARMUP = {2: 1000, 3: 400}  # steps, in which a flow in these boxes builds up
SURE = 3.0  # standard errors within which a law is met
PREFACE = (
    f"Density {DENSITY} of particles, timestep {STEP} unless said, no-slip surfaces with virtual "
    "particles (`fill`), bodies of the fluid's density. The tables state run lengths in steps. A "
    "row that agrees within an error bar wider than its limit says little, and is not listed as "
    "met. Runs of few relaxation times have error bars that are too small."
)


def steps(number: float) -> int:
    """So many steps; few for a quick try."""
    return max(int(number / (50 if SHORT else 1)), 150)


def fluid(rule: str, timestep: float = STEP) -> Fluid:
    """A fluid of 10 particles per cell."""
    collision, thermostat = RULES[rule]
    return Fluid(
        density=DENSITY, timestep=timestep, collision=collision,
        **({"thermostat": thermostat} if thermostat else {}),
    )  # fmt: skip


def coefficients(rule: str, d: int, timestep: float = STEP) -> Any:
    """Transport coefficients of theory."""
    collision, thermostat = RULES[rule]
    return theory.transport(
        rule, d, DENSITY, timestep, angle=getattr(collision, "angle", None),
        thermostat="maxwell-boltzmann" if thermostat else "none",
    )  # fmt: skip


def viscosity(rule: str, d: int) -> float:
    """Dynamic viscosity of molecular chaos."""
    return DENSITY * float(coefficients(rule, d).viscosity)


def case_of(body: Any, side: int, rule: str, length: float, *observe: Any, **more: Any) -> Case:
    """Bodies in a periodic cube or square; `more` has timestep, shear_rate or walls."""
    bodies = body if isinstance(body, tuple) else (body,)
    planar = 3 not in bodies[0].dimensions or isinstance(
        getattr(bodies[0], "parts", (None,))[0], Rectangle
    )
    d = 2 if planar else 3
    size = more.pop("size", [side] * d)
    number, warmup = steps(length), WARMUP[d]
    return Case(
        run=Run(steps=number, warmup=warmup, seed=11),
        box=Box(size, shear_rate=more.pop("shear_rate", 0.0)),
        fluid=fluid(rule, more.pop("timestep", STEP)), bodies=bodies, observe=list(observe), **more,
    )  # fmt: skip


class AtRest(NamedTuple):
    """A body at rest in a box: its name, side of the box, rule, timestep, and steps of its run."""

    name: str
    body: Any
    side: int
    rule: str
    timestep: float
    length: float

    @property
    def key(self) -> str:
        """What the folders of its runs end with."""
        return f"{self.name}-{self.rule}-{self.timestep}".replace(" ", "")

    def case(self, share: float = 1.0) -> Case:
        """Its motion, over a share of the steps."""
        length = share * self.length
        return case_of(
            self.body, self.side, self.rule, length, BodyMotion(), timestep=self.timestep
        )


def at_rest() -> Iterator[AtRest]:
    """Shapes of unequal sizes at three timesteps, and a sphere in SRD."""
    for name, body, side, length in (
        ("sphere R = 2", SphereBody(radius=2), 12, 5e4),
        ("sphere R = 3", SphereBody(radius=3), 16, 1.5e4),
        ("sphere R = 5", SphereBody(radius=5), 20, 7e3),
        ("spheroid 6 x 3", SpheroidBody(half_length=3, radius=1.5), 12, 3e4),
        ("union of spheres", UnionBody(parts=DUMBBELL), 12, 3e4),
        ("disk R = 2", DiskBody(radius=2), 16, 1.2e5),
        ("disk R = 3", DiskBody(radius=3), 24, 1e5),
        ("disk R = 5", DiskBody(radius=5), 30, 9e4),
        ("union, an L", UnionBody(parts=L_SHAPE), 20, 1e5),
    ):
        for timestep in (0.05, STEP, 0.3):
            yield AtRest(name, body, side, "at+a", timestep, length)
    yield AtRest("sphere R = 2", SphereBody(radius=2), 12, "srd", STEP, 5e4)


def ran(page: Page, name: str, case: Case) -> Any:
    """Results of a run, and a note of its length."""
    return page.run(name, case), f"{case.run.steps} steps"


def met(page: Page, what: str, c: Comparison, percent: float) -> None:
    """Check that a number is within 3 standard errors, or so many per cent, of theory.

    An error bar above so many per cent can only show that the law is not met.
    """
    near, allowed = abs(c.measured - c.expected), percent / 100 * abs(c.expected)
    if c.error > allowed and near < SURE * c.error:
        return
    page.check(
        f"{what}: {c.percent:+.1f} +- {100 * c.error / abs(c.expected):.1f} % off theory (within "
        f"{percent:g} % or {SURE:g} s.e.)",
        near < max(SURE * c.error, allowed),
    )


def kept(page: Page, name: str, asked: str, make: Callable[[], np.ndarray]) -> np.ndarray:
    """An array that takes long to make, or the same read from build/validation if it is there."""
    folder = RUNS / ("short" if SHORT else "") / page.name
    folder.mkdir(parents=True, exist_ok=True)
    file, about = folder / f"{name}.npy", folder / f"{name}.json"
    known = json.loads(about.read_text()) if about.exists() else {}
    if not (file.exists() and known.get("asked") == asked):
        print(f"  recording {name}", flush=True)
        begun = time.perf_counter()
        np.save(file, make())
        known = {"asked": asked, "seconds": time.perf_counter() - begun, "sources": sources()}
        about.write_text(json.dumps(known))
        page.began += known["seconds"]
    page.kept += known["seconds"]
    page.sources.add(known["sources"])
    return np.load(file)


def recorded(
    page: Page, name: str, case: Case, often: int, look: Callable[[Any], Any]
) -> np.ndarray:
    """What `look` sees of the engine of a run, every so many steps after the warmup."""

    def make() -> np.ndarray:
        rows: list[Any] = []

        def note(simulation: Any) -> None:
            if simulation.step >= case.run.warmup:
                rows.append(look(simulation.engine))

        Simulation(case, threads=1, callbacks=[every(often, note)]).run()
        return np.array(rows)

    return kept(page, name, case.to_toml(), make)


def share_of(rule: str, d: int) -> float:
    """The share of the viscosity that does not conserve angular momentum."""
    known = coefficients(rule, d)
    return 0.0 if "+a" in rule else known.viscosity_collisional / known.viscosity


def mean_of_parts(values: np.ndarray, parts: int = 10) -> tuple[float, float]:
    """Mean of a series, and its standard error from so many parts of it."""
    means = [part.mean() for part in np.array_split(values, parts)]
    return float(np.mean(means)), float(np.std(means, ddof=1) / math.sqrt(parts))


def gap_energy(gap: np.ndarray) -> np.ndarray:
    """Energy of the repulsion of two surfaces, over kT, as bodies have it unless said."""
    law = GapPotential()
    sigma = law.range / 2 ** (1 / 6)
    x = (sigma / np.clip(gap, 1e-3, law.range)) ** 6
    return 4 * law.depth * (x**2 - x) + law.depth
