"""Values that are fine alone and wrong together. Each rule yields what is wrong, key path first."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from mesokit.box import AXES
from mesokit.component import show
from mesokit.errors import CaseError
from mesokit.io.trajectory import written
from mesokit.mpcd.molecule import COARSE, MOST_SUBSTEPS, UNSTABLE
from mesokit.observe import setting
from mesokit.potential.thermal import mean_square
from mesokit.solute_combinations import solutes
from mesokit.units import MATCHES
from mesokit.wall_combinations import moving_surfaces, room, surfaces, walls

if TYPE_CHECKING:
    from mesokit.case import Case

MOST_CELLS = MOST_PARTICLES = 2**31 - 1  # their numbers are 32-bit
MOST_BINS = 2**24  # of one observable: some gigabytes
LONGEST_PATH = 10.0  # cells


def check(case: Case) -> None:
    """Raise CaseError for the first combination that has no physics."""
    for rule in RULES:
        for problem in rule(case):
            raise CaseError(problem)
    for i, observable in enumerate(case.observe):
        try:
            observable.check(case)
        except CaseError as error:
            reason = str(error).removeprefix(f"{observable.label}: ")
            joint = "." if re.match(r"\w+ = ", reason) else f" ({observable.label}): "
            raise CaseError(f"observe[#{i + 1}]{joint}{reason}") from None


def size(case: Case) -> Iterator[str]:
    """Neither empty nor beyond what can be numbered."""
    if case.box.volume > MOST_CELLS:
        yield f"box.size = {show(case.box.size)}: expected at most {MOST_CELLS} cells"
    if case.particles < 2 and (case.solutes is None or case.solutes.solvent == "fluid"):
        yield f"fluid.density = {show(case.fluid.density)}: fewer than 2 particles in this box"
    if case.particles > MOST_PARTICLES:
        yield (
            f"fluid.density = {show(case.fluid.density)}: {case.particles} particles in this box; "
            f"expected at most {MOST_PARTICLES}"
        )


def mean_free_path(case: Case) -> Iterator[str]:
    """A fluid whose particles meet."""
    fluid = case.fluid
    path = fluid.timestep * math.sqrt(fluid.kT / fluid.mass)
    if path > LONGEST_PATH:
        yield (
            f"fluid.timestep = {show(fluid.timestep)}: the mean free path timestep sqrt(kT/mass) "
            f"is {path:.3g} cells; expected at most {LONGEST_PATH:g}"
        )


def bins(case: Case) -> Iterator[str]:
    """No more than fit into the memory."""
    for i, observable in enumerate(case.observe):
        per_cell = getattr(observable, "bins_per_cell", None)
        if per_cell is None:
            continue
        axes = getattr(observable, "axes", None) or (getattr(observable, "axis", "x"),)
        lengths: dict[str, int] = dict(zip(AXES, case.box.size, strict=False))
        number = math.prod(lengths.get(axis, 1) * per_cell for axis in axes)
        if number > MOST_BINS:
            yield (
                f"observe[#{i + 1}].bins_per_cell = {per_cell}: {number} bins in this box; "
                f"expected at most {MOST_BINS}"
            )


def vectors(case: Case) -> Iterator[str]:
    """One number for each axis."""
    for key, vector in _vectors(case):
        if len(vector) != case.box.dimension:
            yield (
                f"{key} = {show(vector)}: expected {case.box.dimension} numbers, "
                f"one for each axis of the {case.box.dimension}D box"
            )


def axes(case: Case) -> Iterator[str]:
    """No z in 2D."""
    named = [
        (f"wall[#{i + 1}].{key}", getattr(wall, key))
        for i, wall in enumerate(case.walls)
        for key in ("axis", "across")
        if isinstance(getattr(wall, key, None), str)
    ]
    force = case.fluid.force
    if force.rule == "sinusoidal":
        named += [("fluid.force.flow", force.flow), ("fluid.force.gradient", force.gradient)]
    for key, axis in named:
        if axis not in case.box.axes:
            yield f"{key} = {show(axis)}: a 2D box has only 'x' and 'y'"


def collision(case: Case) -> Iterator[str]:
    """Angles that the dimension allows, and no second thermostat."""
    rule, thermostat = case.fluid.collision, case.fluid.thermostat
    if rule.rule == "srd" and rule.angle_distribution == "uniform":
        if case.box.dimension == 3:
            yield "fluid.collision.angle_distribution = 'uniform': only in 2D; in 3D use rule 'at'"
        if rule.angle != type(rule)().angle:
            yield (
                f"fluid.collision.angle = {show(rule.angle)}: no effect with "
                "angle_distribution = 'uniform'; leave it out"
            )
    elif rule.rule in ("srd", "srd+a") and rule.angle == 180 and case.box.dimension == 2:
        yield (
            "fluid.collision.angle = 180: in 2D a half turn keeps the shear stress for ever; "
            "expected less than 180"
        )
    if rule.rule in ("at", "at+a") and thermostat.rule != "none":
        yield (
            f"fluid.thermostat.rule = {show(thermostat.rule)}: collision rule {show(rule.rule)} is "
            "its own thermostat; leave the thermostat out"
        )


def force(case: Case) -> Iterator[str]:
    """A sine across its own direction, and along the plates."""
    rule = case.fluid.force
    if rule.rule != "sinusoidal":
        return
    if rule.flow == rule.gradient:
        yield f"fluid.force.gradient = {show(rule.gradient)}: expected another axis than flow"
    if rule.flow in _closed(case):
        yield f"fluid.force.flow = {show(rule.flow)}: expected an axis that no wall closes"


def shear(case: Case) -> Iterator[str]:
    """Lees-Edwards images along y, flow along x."""
    rate, rule = case.box.shear_rate, case.fluid.force
    if rate == 0:
        if case.box.shear_frequency:
            yield (
                f"box.shear_frequency = {show(case.box.shear_frequency)}: needs box.shear_rate, "
                "the amplitude of the shear rate"
            )
        return
    key = f"box.shear_rate = {show(rate)}"
    for i, wall in enumerate(case.walls):
        if wall.shape != "plates" or len(case.walls) > 1 or wall.diffuse:
            yield f"{key}: not with wall[#{i + 1}].shape = {show(wall.shape)}; only with one slit"
        elif wall.axis in ("x", "y"):
            yield f"{key}: not with walls across {wall.axis}; move a plate to shear a slit"
    if rule.rule == "sinusoidal":
        yield f"{key}: not with a sinusoidal force"
    if rule.rule == "uniform" and rule.acceleration[1] != 0:
        yield f"{key}: not with fluid.force.acceleration along y, the gradient of the shear"


def molecule(case: Case) -> Iterator[str]:
    """Whole molecules, of one mass, in a box that holds them, by stable sub-steps."""
    fluid, molecule = case.fluid, case.fluid.molecule
    if molecule is None:
        return
    if fluid.species:
        yield "fluid.species: not with fluid.molecule; its beads have one mass, fluid.mass"
    number = fluid.density * case.box.volume
    whole = all(wall.shape == "plates" for wall in case.walls)
    if whole and round(number) % molecule.length:
        near = max(1, round(number / molecule.length)) * molecule.length
        yield (
            f"fluid.molecule.length = {molecule.length}: {round(number)} particles are no whole "
            f"number of such molecules; fluid.density = {show(near / case.box.volume)} makes "
            f"{near // molecule.length} of them"
        )
    size = math.sqrt(
        mean_square(molecule.bond_potentials, case.box.dimension, fluid.kT, molecule.bond.longest)
    )
    if 2 * size > min(case.box.size):
        yield (
            f"fluid.molecule.bond: its root-mean-square length {size:.3g} is more than half of "
            f"the box, {show(min(case.box.size))}; expected stiffer bonds or a larger box"
        )
    if molecule.propagation == "exact":
        key = "fluid.molecule.propagation = 'exact'"
        if case.walls:
            yield f"{key}: not with walls, of which its curved flights know nothing; use 'verlet'"
        if fluid.force.rule == "sinusoidal":
            yield f"{key}: not with fluid.force.rule = 'sinusoidal'; use 'verlet'"
        return
    phase = molecule.phase(case.box.dimension, fluid.timestep, fluid.kT, fluid.mass)
    if molecule.substeps is not None and phase >= UNSTABLE:
        need = molecule.needed_substeps(case.box.dimension, fluid.timestep, fluid.kT, fluid.mass)
        yield (
            f"fluid.molecule.substeps = {molecule.substeps}: the stiffest spring turns by "
            f"{phase:.3g} rad in a sub-step and is unstable from {UNSTABLE:g} on; expected at "
            f"least {math.ceil(molecule.substeps * phase / COARSE)}, or none: {need} are then taken"
        )
    if molecule.substeps is None:
        need = molecule.needed_substeps(case.box.dimension, fluid.timestep, fluid.kT, fluid.mass)
        if need > MOST_SUBSTEPS:
            yield (
                f"fluid.molecule: its stiffest spring needs {need} sub-steps in a timestep; "
                f"expected at most {MOST_SUBSTEPS}: a shorter timestep, or softer springs"
            )


def start(case: Case) -> Iterator[str]:
    """Arrays, an earlier run or a file."""
    for owner in ("fluid", "solutes"):
        if getattr(case, owner) is None:
            continue
        given, where = getattr(case, owner).start, f"{owner}.start"
        for key in ("run", "file"):
            value = getattr(given, key)
            if value is not None and (given.positions or given.velocities):
                yield f"{where}.{key} = {show(value)}: not with positions or velocities"
        if given.run is not None and given.file is not None:
            yield f"{where}.file = {show(given.file)}: not with run"


def names(case: Case) -> Iterator[str]:
    """Results are kept by name."""
    seen: dict[str, int] = {}
    for i, observable in enumerate(case.observe):
        label = observable.label
        if label in seen:
            yield (
                f"observe[#{i + 1}].name: {show(label)} is also the name of "
                f"observe[#{seen[label]}]; give one of them a name"
            )
        seen[label] = i + 1
        if not label.replace("-", "").replace("_", "").isalnum():
            yield (
                f"observe[#{i + 1}].name = {show(label)}: expected letters, digits, '-' and '_' "
                "(it names a file)"
            )


def trajectory(case: Case) -> Iterator[str]:
    """Particles that exist, each field once."""
    given = case.trajectory
    if given is None:
        return
    number, _ = written(case)
    if given.of == "solutes" and case.solutes is None:
        yield "trajectory.of = 'solutes': there are none; give solutes"
    elif number == 0:
        yield f"trajectory.of = {show(given.of)}: there is no such particle"
    elif given.subset is not None and given.subset > number:
        yield f"trajectory.subset = {given.subset}: there are only {number} particles"
    if len(set(given.fields)) < len(given.fields):
        yield f"trajectory.fields = {show(given.fields)}: expected each field once"


def units(case: Case) -> Iterator[str]:
    """Units in SI that the case and the real fluid can be matched by."""
    given = case.units
    if given is None:
        return
    if case.box.dimension == 3 and given.depth is not None:
        yield f"units.depth = {show(given.depth)}: only in 2D; a 3D box has its own; leave it out"
    if case.box.dimension == 2 and given.match == "peclet":
        yield (
            "units.match = 'peclet': only in 3D; the diffusion of a disc in a 2D fluid depends on "
            "the box (Stokes' paradox); use 'reynolds' or 'thermal'"
        )
    caveat, matched = setting.caveat(case), MATCHES[given.match]
    if caveat and not {"dynamic_viscosity", "sound_speed"}.isdisjoint(matched):
        yield f"units.match = {show(given.match)}: {caveat}; only 'thermal' does without"
    if any(math.isnan(getattr(given.fluid.properties(), name)) for name in matched):
        yield f"units.fluid.sound_speed: missing; units.match = {show(given.match)} needs it"


RULES: tuple[Callable[[Case], Iterator[str]], ...] = (
    axes, vectors, walls, room, moving_surfaces, size, mean_free_path, collision, force, shear,
    molecule, solutes, start, names, bins, trajectory, units,
)  # fmt: skip


def _closed(case: Case) -> set[str]:
    """Axes that plates close."""
    return {wall.axis for wall in case.walls if wall.shape == "plates"}


def _vectors(case: Case) -> Iterator[tuple[str, tuple[float, ...]]]:
    if case.fluid.force.rule == "uniform":
        yield "fluid.force.acceleration", case.fluid.force.acceleration
    for i, wall in enumerate(case.walls):
        if wall.shape != "plates" and case.box.dimension in wall.dimensions:
            for key, vector in wall.vectors().items():
                yield f"wall[#{i + 1}].{key}", vector
    for key, surface, _ in surfaces(case):
        if surface.velocity is not None:
            yield f"{key}.velocity", surface.velocity
