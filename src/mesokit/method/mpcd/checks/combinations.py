"""Values that are fine alone and wrong together. Each rule yields what is wrong, key path first."""

import math
from collections.abc import Callable, Iterator
from typing import Any

from mesokit.case.amounts import count_text
from mesokit.case.case import Case
from mesokit.case.checks import whole_cells
from mesokit.case.component import name_of, show
from mesokit.case.outside import is_outside
from mesokit.case.registry import address
from mesokit.case.units import MATCHES
from mesokit.errors import CaseError
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.walls import room, surfaces
from mesokit.method.mpcd.checks.bodies import bodies
from mesokit.method.mpcd.checks.solutes import solutes
from mesokit.method.mpcd.checks.walls import moving_surfaces, walls
from mesokit.method.mpcd.collision.protocol import coefficients, collide, contribute, freedom
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.method.mpcd.molecule import COARSE, MOST_SUBSTEPS, UNSTABLE
from mesokit.method.mpcd.thermostat.protocol import target
from mesokit.potential.thermal import mean_square

MOST_CELLS = MOST_PARTICLES = 2**53  # whole numbers that floats can tell apart
MOST_CELLS_AMONG_SOLIDS = 2**27  # some hundred bytes for each while tables are made
LONGEST_PATH = 10.0  # cells


def check(case: Case) -> None:
    """Raise CaseError for the first combination that has no physics."""
    whole_cells(case.box)
    for rule in RULES:
        for problem in rule(case):
            raise CaseError(problem)


def cells(case: Case) -> Iterator[str]:
    """No more cells than can be numbered, and among solids than tables have room for."""
    among = not all(isinstance(wall, Plates) for wall in case.walls)
    most, where = (MOST_CELLS_AMONG_SOLIDS, " among solids") if among else (MOST_CELLS, "")
    if case.box.volume > most:
        yield f"box.size = {show(case.box.size)}: expected at most {most} cells{where}"


def size(case: Case) -> Iterator[str]:
    """Neither empty nor with more particles than can be numbered."""
    alone = case.solutes is None or case.solutes.coupling == "collision"
    random = case.solutes is not None and case.solutes.solvent == "random"
    if case.particles < 2 and alone and not random:
        yield f"fluid.density = {show(case.fluid.density)}: fewer than 2 particles in this box"
    if case.particles > MOST_PARTICLES:
        yield (
            f"fluid.density = {show(case.fluid.density)}: {count_text(case.particles)} particles "
            f"in this box; expected at most {MOST_PARTICLES}"
        )


def check_mean_free_path(case: Case) -> Iterator[str]:
    """A fluid whose particles meet."""
    fluid = case.fluid
    path = fluid.timestep * math.sqrt(fluid.kT / fluid.mass)
    if path > LONGEST_PATH and fluid.collision.acts:
        yield (
            f"fluid.timestep = {show(fluid.timestep)}: the mean free path timestep sqrt(kT/mass) "
            f"is {path:.3g} cells; expected at most {LONGEST_PATH:g}"
        )


def vectors(case: Case) -> Iterator[str]:
    """One number for each axis."""
    given = [(f"fluid.force.{key}", vector) for key, vector in case.fluid.force.vectors().items()]
    given += [
        (f"{key}.velocity", s.velocity) for key, s, _ in surfaces(case) if s.velocity is not None
    ]
    for key, vector in given:
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
    named += [(f"fluid.force.{key}", axis) for key, axis in case.fluid.force.axes().items()]
    for key, axis in named:
        if axis not in case.box.axes:
            yield f"{key} = {show(axis)}: a 2D box has only 'x' and 'y'"


def collision(case: Case) -> Iterator[str]:
    """Angles that the dimension allows, no second thermostat, species, shear and solutes."""
    rule, thermostat = case.fluid.collision, case.fluid.thermostat
    for problem in rule.problems(case.box.dimension):
        yield f"fluid.collision.{problem}"
    if rule.isothermal and thermostat.acts:
        yield (
            f"fluid.thermostat.rule = {show(name_of(thermostat))}: collision rule "
            f"{show(name_of(rule))} is its own thermostat; leave the thermostat out"
        )
    species, name = len(case.fluid.species), show(name_of(rule))
    if rule.kinds is not None and species != rule.kinds:
        yield f"fluid.species: {species} of them; collision rule {name} needs {rule.kinds}"
    if rule.gradient_of is None:
        return
    if case.box.sheared:
        yield f"{case.box.shear_key}: not with collision rule {name}; move a plate to shear a slit"
    if case.solutes is not None:
        yield f"solutes: not with collision rule {name}, which knows two species of the fluid alone"


def free_flight(case: Case) -> Iterator[str]:
    """Nothing that needs collisions."""
    fluid, rule = case.fluid, show(name_of(case.fluid.collision))
    if fluid.collision.acts:
        return
    if fluid.thermostat.acts:
        yield (
            f"fluid.thermostat.rule = {show(name_of(fluid.thermostat))}: acts in collisions, and "
            f"collision rule {rule} has none; leave the thermostat out"
        )
    if case.box.sheared:
        yield (
            f"{case.box.shear_key}: not with collision rule {rule}, "
            "which carries no shear from particle to particle"
        )
    if case.solutes is not None and case.solutes.solvent == "random":
        yield (
            f"solutes.solvent = 'random': acts in collisions, and collision rule {rule} has "
            "none; use 'fluid'"
        )


def open_box(case: Case) -> Iterator[str]:
    """No bounds but for particles that fly freely, and nothing at them."""
    given, box = f"box.open = {show(list(case.box.open))}", case.box
    if not box.open:
        return
    for axis in box.open:
        if axis not in box.axes:
            yield f"{given}: a 2D box has only 'x' and 'y'"
    if case.fluid.collision.acts:
        rule = show(name_of(case.fluid.collision))
        yield f"{given}: only with collision rule 'none'; cells of rule {rule} need a periodic box"
    for i, wall in enumerate(case.walls):
        yield f"{given}: not with wall[#{i + 1}].shape = {show(name_of(wall))}; leave one out"
    if case.solutes is not None:
        yield f"{given}: not with solutes; leave one of both out"
    for i, observable in enumerate(case.observe):
        if not observable.in_open_box:
            yield (
                f"observe[#{i + 1}].quantity = {show(name_of(observable))}: not with {given}; it "
                "needs particles that are in the box"
            )


def force(case: Case) -> Iterator[str]:
    """A body force that fits the box and its walls."""
    for problem in case.fluid.force.misfits(case.box.size):
        yield f"fluid.force.{problem}"
    for problem in case.fluid.force.problems({*closed_axes(case.walls), *case.box.open}):
        yield f"fluid.force.{problem}"


def shear(case: Case) -> Iterator[str]:
    """Lees-Edwards images along y, flow along x."""
    box, rule = case.box, case.fluid.force
    if box.shear_frequency and not box.shear_rate:
        yield (
            f"box.shear_frequency = {show(box.shear_frequency)}: needs box.shear_rate, "
            "the amplitude of the shear rate"
        )
    if box.shear is not None:
        if box.shear_rate:
            yield f"box.shear_rate = {show(box.shear_rate)}: not with box.shear; give one of them"
        for problem in box.shear.problems():
            yield f"box.shear.{problem}"
    if not box.sheared:
        return
    key = box.shear_key
    for i, wall in enumerate(case.walls):
        if not isinstance(wall, Plates) or len(case.walls) > 1 or wall.diffuse:
            shape = show(name_of(wall))
            yield f"{key}: not with wall[#{i + 1}].shape = {shape}; only with one slit"
        elif wall.axis in ("x", "y"):
            yield f"{key}: not with walls across {wall.axis}; move a plate to shear a slit"
    uniform = rule.uniform(case.box.dimension)
    if uniform is None:
        yield f"{key}: not with fluid.force.rule = {show(name_of(rule))}"
    elif uniform[1] != 0:
        yield f"{key}: not with fluid.force.acceleration along y, the gradient of the shear"


def molecule(case: Case) -> Iterator[str]:
    """Whole molecules, of one mass, in a box that holds them, by stable sub-steps."""
    fluid, molecule = case.fluid, case.fluid.molecule
    if molecule is None:
        return
    if fluid.species:
        yield "fluid.species: not with fluid.molecule; its beads have one mass, fluid.mass"
    number = fluid.density * case.box.volume
    whole = all(isinstance(wall, Plates) for wall in case.walls)
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
        if fluid.force.uniform(case.box.dimension) is None:
            yield f"{key}: not with fluid.force.rule = {show(name_of(fluid.force))}; use 'verlet'"
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


def kernels(case: Case) -> Iterator[str]:
    """Functions that the compiled code of a rule, thermostat or force from outside needs."""
    fluid, d = case.fluid, case.box.dimension
    rule, bath, force = fluid.collision, fluid.thermostat, fluid.force
    needed: tuple[tuple[str, Any, Callable[[], Any], tuple[Any, ...]], ...] = (
        (
            "collision",
            rule,
            lambda: rule.kernel(d, fluid.kT),
            (contribute, freedom, coefficients, collide),
        ),
        ("thermostat", bath, lambda: bath.kernel(fluid.kT, 0.0), (target,)),
        ("force", force, lambda: force.kernel(case.box.size), (acceleration,)),
    )
    for key, part, kernel, functions in needed:
        if not is_outside(part):
            continue
        place = address(type(part))
        try:
            kind = type(kernel())
        except Exception as error:
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            yield f"fluid.{key}: {place} has no parameters for its kernel: {reason}"
            continue
        for function in functions:
            if kind not in function.implementations and not function.others:
                yield f"fluid.{key}: {place} registers no {function.__name__} for {kind.__name__}"


def check_start(case: Case) -> Iterator[str]:
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
    caveat, matched = setting.caveat_of_fluid(case), MATCHES[given.match]
    if caveat and not {"dynamic_viscosity", "sound_speed"}.isdisjoint(matched):
        yield f"units.match = {show(given.match)}: {caveat}; only 'thermal' does without"
    if any(math.isnan(getattr(given.fluid.properties(), name)) for name in matched):
        yield f"units.fluid.sound_speed: missing; units.match = {show(given.match)} needs it"


RULES: tuple[Callable[[Case], Iterator[str]], ...] = (
    axes,
    cells,
    vectors,
    walls,
    lambda case: room(case, "fluid"),
    moving_surfaces,
    bodies,
    size,
    check_mean_free_path,
    collision,
    free_flight,
    open_box,
    force,
    shear,
    molecule,
    solutes,
    check_start,
    units,
    kernels,
)
