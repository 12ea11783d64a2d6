"""The figures of the thesis on viscoelastic fluids, from the cases in examples/viscoelastic."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import viscoelastic_modes as modes
import viscoelastic_shear as shear
from common import ROOT, Page, decimals, found, long, main

from mesokit import Case, Comparison

EXAMPLES = ROOT / "examples" / "viscoelastic"
FIVE = tuple(f"5.{n}" for n in range(1, 13))
PICTURES = {
    "4": ("4.1", "4.2"), "simple": ("5.1", "5.2"), "dimers": ("5.3", "5.4", "5.5"),
    "decamers": ("5.6", "5.7", "5.8", "5.9"), "theory": ("5.10", "5.11", "5.12"),
    "trimers": ("6.1", "6.2"),
}  # fmt: skip
WIDER = 0.02  # what theory is short of in bonded_modes: the background viscosity
HELD, FREE = (0.03, 0.1, 0.3), (0.03, 0.1, 0.3)  # shear rates of figures 6.1 and 6.2


def example(name: str) -> Case:
    """A case of the examples, of the length that this script asks for."""
    case = Case.from_toml(EXAMPLES / f"{name}.toml")
    return dataclasses.replace(case, run=dataclasses.replace(case.run, steps=long(case.run.steps)))


def file_of(figure: str) -> str:
    """5.10: fig_5_10."""
    return "fig_" + figure.replace(".", "_")


def parameters(case: Case, several: bool = False) -> str:
    """What sets a case apart, or a few cases that differ in shear rate and spring."""
    said = ["box " + " x ".join(map(str, case.box.size))]
    if case.fluid.molecule is not None:
        spring = "" if several else f", K = {case.fluid.molecule.bond.K:.4g}"
        said.append(f"{case.fluid.molecule.length} beads{spring}")
    if case.box.shear_rate and not several:
        said.append(f"shear rate {case.box.shear_rate:g}")
    if case.fluid.grid_shift < 1:
        said.append(f"grid shift {case.fluid.grid_shift:g}")
    return ", ".join([*said, f"{case.run.steps} steps"])


def summary(page: Page, rows: dict[str, list[Comparison]], cases: dict[str, Case]) -> None:
    """The table: a row for each number of each figure."""
    picture = {figure: name for name, those in PICTURES.items() for figure in those}
    lines: list[list[Any]] = []
    for figure, numbers in rows.items():
        for first, c in zip([True] + [False] * len(numbers), numbers, strict=False):
            link = f"[{file_of(figure)}.toml](../../examples/viscoelastic/{file_of(figure)}.toml)"
            digits = decimals(c.error, c.measured)
            lines.append([
                figure if first else "", link if first else "",
                parameters(cases[figure], figure[0] == "6") if first else "", c.what,
                f"{c.measured:.{digits}f} {c.unit}", f"{c.error:.{digits}f}",
                f"{c.expected:.{digits}f}",
                f"{c.deviation:+.1f}" if math.isfinite(c.deviation) else "", c.note,
                f"[picture](viscoelastic_{picture[figure]}.png)" if first else "",
            ])  # fmt: skip
    page.grid(
        ["figure", "case", "parameters", "quantity", "measured", "standard error", "theory",
         "in s.e.", "note", "picture"],
        lines,
    )  # fmt: skip


def shear_profiles(page: Page, rows: dict[str, list[Comparison]], cases: dict[str, Case]) -> Any:
    """Figures 4.1 and 4.2."""
    half = cases["4.2"]
    none = dataclasses.replace(half, fluid=dataclasses.replace(half.fluid, grid_shift=0.0))
    results = {
        name: (case, page.run(f"4-{name}", case)["velocity-profile"])
        for name, case in (("full", cases["4.1"]), ("half", half), ("no", none))
    }
    whole = found(results["full"][1], "shear rate")
    cells = {name: shear.within_cells(name) for name in results}
    rows["4.1"] = [whole, cells["full"][2]]
    rows["4.2"] = [cells[name][2] for name in ("half", "no")]
    page.check(f"4.1: slope {whole.percent:+.2f} % from the shear rate (at most 1 %)",
               abs(whole.percent) < 1)  # fmt: skip
    steps = [rows["4.1"][1], *rows["4.2"]]
    page.check("4.2: the smaller the grid shift, the smaller the shear rate within cells",
               steps[0].measured > steps[1].measured > steps[2].measured)  # fmt: skip
    return shear.profiles(results, cells)


def decays(page: Page, rows: dict[str, list[Comparison]], cases: dict[str, Case],
           bead: shear.Bead) -> tuple[dict[str, Any], dict[str, Comparison]]:  # fmt: skip
    """Figures 5.1 to 5.12: all curves, and the time of the slowest mode where there is one."""
    curves, slowest = {}, {}
    for figure in FIVE:
        case = cases[figure]
        files = page.run(figure.replace(".", "-"), case)
        background = None
        if case.fluid.molecule is not None:
            slowest[figure] = modes.mode_time(files)
            background = shear.background(page, case, slowest[figure].measured / 2)
        curves[figure] = modes.curves(figure, case, files, background)
        rows[figure] = modes.rows_of(curves[figure], case, files, background, bead.friction)
        for c in rows[figure]:
            if c.what.startswith("viscosity"):
                spread = 100 * c.error / c.expected
                page.check(f"{figure}: {c.what} {c.percent:+.1f} +- {spread:.1f} % from theory "
                           "(at most 5 %, and its error)",
                           abs(c.measured - c.expected) < 0.05 * c.expected + c.error)  # fmt: skip
            elif c.what.endswith(modes.BEST):
                page.check(
                    f"{figure}: {c.what} {c.measured:+.3f} +- {c.error:.3f} "
                    f"(at most {WIDER}, and three errors)",
                    abs(c.measured) < WIDER + 3 * c.error,
                )
    return curves, slowest


def make() -> int:
    """Write the page."""
    page = Page("viscoelastic", "Figures of the thesis on viscoelastic fluids")
    names = ("4.1", "4.2", *FIVE, "6.1", "6.2")
    cases = {figure: example(file_of(figure)) for figure in names}
    rows: dict[str, list[Comparison]] = {figure: [] for figure in names}
    bead, diffusion = shear.free_bead(page, cases["5.1"])
    fig_4 = shear_profiles(page, rows, cases)
    curves, slowest = decays(page, rows, cases, bead)
    held = []
    for rate in HELD:
        K = shear.theory.trimer_spring_constant(2, rate, bead.viscosity, bead.radius)
        held.append((rate, K, shear.bonds(page, "held", cases["6.1"], bead, rate, K)))
    free = [(rate, shear.bonds(page, "free", cases["6.2"], bead, rate, 1.0)) for rate in FREE]
    rows["6.1"], rows["6.2"] = [c for _, _, c in held], [c for _, c in free]
    for figure in ("6.1", "6.2"):
        for c in rows[figure]:
            page.check(f"{figure}: {c.what}: {c.percent:+.2f} % from theory (at most 2.5, 5 % "
                       "of the mean square)",
                       abs(c.percent) < 2.5)  # fmt: skip

    page.text(
        'D. Toneian, "Multi-Particle Collision Dynamics" Simulation of Viscoelastic Fluids, TU '
        "Wien (2015). Each figure is a case in examples/viscoelastic, smaller than in the thesis "
        "(the cases say by how much); all have SRD at 2.27 rad, density 10, timestep 0.1. Where "
        "the thesis is in error, theory is the corrected one "
        "([polymers and bonded fluids](../theory-polymers.md))."
    )
    summary(page, rows, cases)
    page.text(
        f"A free particle of this fluid diffuses with D = {diffusion.measured:.5f} +- "
        f"{diffusion.error:.5f} in a box of {cases['5.1'].box.size[0]} cells: a friction of "
        f"{bead.friction:.2f} +- {bead.error:.2f} in a large one, a hydrodynamic radius of "
        f"{bead.radius:.4f}. That number and the theoretical viscosity are all that the times of "
        "modes and the trimers are compared with. Deviations of the velocity modes are from "
        "theory with the measured time of the slowest mode (half of it is the stress time) and the "
        "background viscosity, up to "
        f"the delay where theory falls below {modes.DROWNED:g} errors; the largest of many delays "
        "is two to three errors where there is nothing but noise."
    )
    page.text(
        "What collisions and flights alone carry in a fluid of molecules, its background "
        "viscosity, is read off the same fluid in slow Lees-Edwards shear: the kinetic and "
        "collisional parts of the stress. Free particles have more: beads that are tied together "
        "move together, the more so the stiffer the springs (decamers of K = 10 have bonds of 0.39 "
        "cells, and lie in a few of them), and exchange less momentum in collisions. Theory with "
        "the viscosity of free particles is off for them."
    )
    page.heading("Simple fluid in shear")
    page.figure(
        fig_4, "Left: figure 4.1. Middle and right: figure 4.2, in the middle of the box and "
        "against the place within a cell, mean over all cells.", "_4",
    )  # fmt: skip
    page.heading("Simple fluid at rest")
    modes.picture(
        page, [(f"figure {n}", curves[n], end) for n, end in (("5.1", 40), ("5.2", 20))],
        "Decay of transverse modes; lines: exp(-nu k^2 t).", "_simple",
    )  # fmt: skip
    page.heading("Dimers")
    page.figure(
        modes.dimer_panels(curves, cases["5.3"], slowest["5.3"].measured),
        "Size of the correlations; lines: theory for finite k. Points that are smaller than their "
        "error are left out. The envelope is that of long waves.", "_dimers",
    )  # fmt: skip
    page.heading("Decamers")
    modes.picture(
        page, [(f"figure {n}, K = {K}", curves[n], 40) for n, K in
               (("5.6", 1), ("5.7", 5), ("5.8", 10), ("5.9", 1))],
        "Lines: theory for finite k; dotted: with the background viscosity of free particles.",
        "_decamers",
    )  # fmt: skip
    page.heading("Any number of springs")
    page.figure(
        modes.theory_panels({n: (cases[n], slowest[n].measured, curves[n][0])
                             for n in PICTURES["theory"]}),
        "Above: the figures' curves of theory. Below: one fluid of each, measured, beside theory "
        "for finite k (dotted: with the background viscosity of free particles).",
        "_theory",
    )  # fmt: skip
    page.heading("Trimers in shear")
    page.text(
        "The theory is one trimer in a simple fluid, its hydrodynamic interaction averaged over "
        "its bonds' mean length; here all particles are beads of trimers, and the background "
        "viscosity is lower. Bonds come out too long where they are stretched most: by 5 to 10 % "
        "of what the flow adds to their mean square."
    )
    page.figure(
        shear.trimers(held, free, bead), "Lines: theory, for the hydrodynamic radius of the "
        "thesis and for that of this fluid. Errors are smaller than the marks.", "_trimers",
    )  # fmt: skip
    page.heading("Viscosity of a fluid of dimers by three routes")
    page.text(
        f"Dimers of figure 5.3. A helical wave of amplitude {shear.WAVE} along a box of "
        f"{shear.ACROSS} x {shear.ACROSS} x {shear.LONG} cells decays slowly, where those of the "
        "thesis' boxes swing (these dimers need more than 123 cells): its late decay is that of "
        "the slow pole. Stress in Lees-Edwards shear ([sheared_dimers.toml]"
        "(../../examples/viscoelastic/sheared_dimers.toml)). Theory: nu + kT tau/2m, the stress "
        "time from the normal modes at rest."
    )
    fig = shear.routes(page, example("sheared_dimers"), bead, slowest["5.5"])
    page.figure(fig, "Left: decay of the wave. Right: the three routes.", "_routes")
    page.heading("Shear-thinning dumbbells")
    page.text(
        "Hookean dimers do not thin. FENE dumbbells ([thinning_dumbbells.toml]"
        "(../../examples/viscoelastic/thinning_dumbbells.toml), k = 1/3, R0 = 6) do. The bond part "
        "of the viscosity beside phi zeta <y^2>/4 (Giesekus), with <y^2> as measured in the same "
        "flow, and at rest from Boltzmann's distribution; zeta from the free bead and the "
        "hydrodynamic interaction of the two."
    )
    fig = shear.thinning(page, example("thinning_dumbbells"), bead)
    page.figure(fig, "Viscosity against shear rate.", "_thinning")
    return page.write()


if __name__ == "__main__":
    main(make)
