"""Properties of a case for theory: coefficients, the state at rest, and the steady flow."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import name_of
from mesokit.geometry import shape_protocol as walls
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import free_volume, slit_of, solids_of
from mesokit.method.mpcd.collision import Gas

Array = NDArray[np.floating[Any]]
THIN = 1.0  # particles per cell: of fewer, viscosities were seen to be 14 % off and more
RAREFIED = 0.03  # mean free path over the distance of plates, above which slip is seen
# third-order Gauss points: exact bin averages of the parabolas that flows are made of
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def transport(case: Case) -> theory.Transport | None:
    """Transport coefficients of the fluid; None without a theory, for which see `caveat`."""
    return None if caveat(case) else of_gas(case)


def of_gas(case: Case) -> theory.Transport | None:
    """Transport coefficients as if its particles were single; None for a half turn in 2D."""
    try:
        return case.fluid.collision.transport(gas(case))
    except ValueError:
        return None


def solvent(case: Case) -> theory.Transport | None:
    """Transport coefficients of a fluid of single particles without the solutes or bodies in it."""
    fluid, alone = case.fluid, case.solutes is None and not case.bodies
    if alone or fluid.mixed or fluid.molecule is not None or fluid.grid_shift < 1:
        return None
    return of_gas(case) if fluid.collision.acts else None


def gas(case: Case) -> Gas:
    """The fluid of a case, as theory takes it."""
    f = case.fluid
    return Gas(case.box.dimension, f.density, f.timestep, f.kT, f.mass, f.thermostat.in_theory)


def caveat(case: Case) -> str:
    """Reason for which there is no theory of the transport coefficients; "" if there is one."""
    return caveat_of_fluid(case) or ("no theory of a fluid with bodies" if case.bodies else "")


def caveat_of_fluid(case: Case) -> str:
    """The same of the fluid around bodies."""
    if not case.fluid.collision.acts:
        return "there are none without collisions"
    if case.fluid.mixed:
        return "no theory of a mixture"
    if case.fluid.molecule is not None:
        among = " with solutes" if case.solutes is not None else ""
        return f"no theory of a fluid of molecules{among}"
    if case.solutes is not None:
        return "no theory of a fluid with solutes"
    if case.fluid.density < THIN:
        return "no theory of so thin a fluid: the same few particles meet again and again"
    return "theory needs the full grid shift" if case.fluid.grid_shift < 1 else ""


def mean_free_path(case: Case) -> float:
    """Thermal velocity times timestep, in cells."""
    return float(case.fluid.timestep * (case.fluid.kT / case.fluid.mass) ** 0.5)


STIRRED = "hydrodynamic backflow adds 10 to 30 %, in 2D more"
STIRRING = "molecular chaos and hydrodynamic backflow, in this box"


def chaos(case: Case, off: str) -> str:
    """The note of a number that molecular chaos gives: `off` is its error where particles
    meet again before they have flown a cell."""
    approximate = mean_free_path(case) < 1
    return caveat(case) or f"approximate: molecular chaos; {off}" * approximate or "molecular chaos"


def loop(case: Case) -> float:
    """Part by which the fluctuations of a fluid raise its viscosity, one loop; 0 where unknown.

    In 2D it grows with the logarithm of the box, whose sides are taken by their geometric mean. The
    shortest wave that counts is 2 cells long for short flights and 8 for flights of a cell.
    Measured: +1.2 % where it is 1.8 (2D, 90 degrees, timestep 0.1), +6.1 where it is 5.2 (3D, 90
    degrees, density 5, timestep 0.25), +0.2 where it is 0.2 (3D, 130 degrees, timestep 1).
    """
    known, d = transport(case), case.box.dimension
    if known is None:
        return 0.0
    length = float(np.prod(case.box.size)) ** (1 / d)
    shortest = 2.0 + 6.0 * min(mean_free_path(case), 1.0) ** 2
    if length <= shortest:
        return 0.0
    fluid, nu = case.fluid, known.viscosity
    sound = known.sound_attenuation or nu
    raised = theory.viscosity_renormalised(
        d, nu, sound, fluid.density, length, fluid.kT, fluid.mass, shortest
    )
    return raised / nu - 1.0


# Mean free paths below which particles that meet again and again lower a viscosity, and the largest
# part that was measured, over rules and dimensions (validation/viscosity_rules.py).
SHORT_FLIGHTS = ((0.03, 0.07), (0.07, 0.03))


def short_flights(case: Case) -> float:
    """The largest part that so short flights take off a viscosity."""
    return next((part for path, part in SHORT_FLIGHTS if mean_free_path(case) < path), 0.0)


def chaos_is_off(case: Case, expected: float, error: float) -> str:
    """A note where a viscosity of molecular chaos is known to be off by more than an error bar: by
    fluctuations, which raise it, or by short flights; "" elsewhere."""
    part = short_flights(case)
    if part * abs(expected) > error:
        return f"approximate: molecular chaos; so short flights take up to {100 * part:.0f} % off"
    part = loop(case)
    if not part * abs(expected) > error:
        return ""
    return f"approximate: molecular chaos; fluctuations add {100 * part:.1g} % or more"


def chaos_label(case: Case) -> str:
    """The same for the legend of a figure."""
    return "molecular chaos" + (", approximate" if mean_free_path(case) < 1 else "")


def warming(case: Case) -> float | None:
    """Rise of the temperature of a held fluid for each unit of the shear rate squared, as it is
    counted about the linear profile; None without a theory."""
    if caveat(case):
        return None
    rise = case.fluid.collision.shear_warming(gas(case))
    return None if rise is None else case.fluid.mass * rise


def offset(case: Case) -> float:
    """Largest known (T - kT)/kT of the fluid at rest."""
    return case.fluid.collision.temperature_offset(gas(case), mean_free_path(case))


def temperature_note(case: Case) -> str:
    """Note on the known deviation of a thermostat from kT, "" below 0.1 %."""
    if case.fluid.mixed:
        parts = (case.fluid.thermostat, case.fluid.collision)
        name = next((name_of(part) for part in parts if not part.one_temperature), "")
        kinds = f"approximate: {name} holds the kinds of a mixture at different temperatures"
        return kinds if name else ""
    percent = 100 * offset(case)
    if abs(percent) <= 0.1:
        return ""
    side = "warm" if percent > 0 else "cold"
    return f"approximate: this thermostat reads up to {abs(percent):.2g} % {side}"


def mass_density(case: Case) -> float:
    """Mass per cell, of solutes too."""
    fluid, solutes = case.fluid.density * case.fluid.mass, case.solutes
    return fluid if solutes is None else fluid + solutes.total_mass / free_volume(case)


def carriers(case: Case) -> tuple[float, float]:
    """Particles and beads per cell, and how many of these move as one: molecules and bodies count
    once.

    The latter is nan where beads of different molecules feel one another.
    """
    density, molecule, solutes = case.fluid.density, case.fluid.molecule, case.solutes
    volume = free_volume(case)
    moving = moving_bodies(case)
    alone = density / (1 if molecule is None else molecule.length) + moving / volume
    density += moving / volume
    if solutes is None:
        return density, alone
    wholes = sum(polymer.number for polymer in solutes.polymers) / volume
    if solutes.different_pairs or solutes.solvent_pair is not None:
        wholes = float("nan")
    return density + solutes.beads / volume, alone + wholes


def superficial_mass(case: Case) -> float:
    """Mass by which momentum of fluid and solutes is divided for their superficial velocity."""
    return mass_density(case) * case.box.volume


def sound_speed(case: Case) -> float:
    """That of theory, or of an ideal gas at kT: fast sound does not feel soft bonds."""
    known, fluid = transport(case), case.fluid
    return known.sound_speed if known else float((fluid.kT / fluid.mass) ** 0.5)


def isothermal(case: Case) -> bool:
    """Whether something holds the fluid at kT everywhere."""
    random = case.solutes is not None and case.solutes.solvent == "random"
    return random or case.fluid.thermostat.acts or case.fluid.collision.isothermal


def at_kT(case: Case) -> bool:
    """True if the fluid is at kT everywhere: nothing heats it, or a thermostat has enough pairs to
    take the heat."""
    return not driven(case) or (isothermal(case) and case.fluid.density >= THIN)


def slipping(case: Case) -> str:
    """Why walls are known not to hold the fluid next to them, "" where they do."""
    thin = "approximate: particles of so thin a fluid fly from wall to wall"
    return thin if case.fluid.density < THIN else rarefied(case)


def rarefied(case: Case) -> str:
    """That flights between plates are not short beside their distance, so that the fluid slips: by
    5 to 8 % of a flow rate where they are a tenth of it (measured in 3D)."""
    wall = slit_of(case)
    part = mean_free_path(case) / float(case.box.size[case.box.index(wall.axis)]) if wall else 0.0
    return f"approximate: slip, flights of {part:.2g} of the channel" if part > RAREFIED else ""


def uniform_acceleration(case: Case) -> Array:
    """The uniform acceleration (d,), zero without one."""
    dimension = case.box.dimension
    return np.array(case.fluid.force.uniform(dimension) or (0.0,) * dimension, float)


def gathered(case: Case) -> bool:
    """Whether a force that is not uniform, or species that demix, may make the density uneven."""
    force, demixes = case.fluid.force, bool(case.fluid.species) and not case.fluid.collision.ideal
    return demixes or (force.gathers and force.uniform(case.box.dimension) is None)


def driven_axis(case: Case) -> int | None:
    """Number of the only axis along which a uniform force drives the fluid, None for another."""
    axes = np.flatnonzero(uniform_acceleration(case))
    return int(axes[0]) if len(axes) == 1 else None


def with_start(case: Case, error: float, expected: float, runs: int = 1) -> float:
    """The error of a number proportional to kT, in a fluid that keeps the energy it started with.

    Drawn velocities have an energy that is off by sqrt(2/(d N)), for ever where nothing heats or
    cools the fluid: one run cannot average over it, but several can. Blocks of time of several runs
    see their starts too, all but the fewest.
    """
    if isothermal(case) or (case.walls and driven(case)):
        return error
    of_starts = expected * (2 / (case.box.dimension * case.particles * runs)) ** 0.5
    return float(np.hypot(error, of_starts) if runs == 1 else np.fmax(error, of_starts))


def driven(case: Case) -> bool:
    """True if anything makes the fluid flow, or gives it momentum."""
    return flowing(case) or magnetic(case)


def flowing(case: Case) -> bool:
    """Whether anything makes the fluid flow: a magnetic field leaves it in equilibrium."""
    return flows_by_itself(case) or stirred(case)


def gives_momentum(case: Case) -> bool:
    """Whether anything but bodies gives momentum to fluid and solutes, or takes it."""
    return flows_by_itself(case) or magnetic(case)


def flows_by_itself(case: Case) -> bool:
    """Whether anything but bodies makes the fluid flow."""
    moving = any(surface.moves for wall in case.walls for surface in wall.surfaces().values())
    held = case.solutes is not None and bool(case.solutes.pulls or case.solutes.traps)
    return bool(case.box.sheared or case.fluid.force.acts or moving or held)


def stirred(case: Case) -> bool:
    """Whether bodies swim, or forces and torques move them."""
    return any(
        kind.swim is not None or np.any(kind.force or 0.0) or np.any(kind.torque or 0.0)
        for kind in case.bodies
    )


def moving_bodies(case: Case) -> int:
    """Number of bodies whose place is not fixed along all axes."""
    return sum(kind.number for kind in case.bodies if not set(case.box.axes) <= set(kind.fixed))


def held_along(case: Case, axis: str) -> bool:
    """Whether places of bodies are fixed or trapped along an axis, and slow what flows there."""
    return any(
        axis in kind.fixed or (kind.trap is not None and kind.trap.k > 0) for kind in case.bodies
    )


def motion_besides(case: Case) -> str:
    """What moves beside thermal motion: "flow", "swimming", "drift"; "" at rest.

    Forces and torques on bodies are drift.
    """
    pushed = any(np.any(one.force or 0.0) or np.any(one.torque or 0.0) for one in case.bodies)
    words = {
        "flow": flows_by_itself(case),
        "swimming": any(one.swim is not None for one in case.bodies),
        "drift": pushed,
    }
    return " and ".join(word for word, there in words.items() if there)


MAGNETIC = "no theory of motion in a magnetic field"


def magnetic(case: Case) -> bool:
    """Whether a magnetic field turns the velocities of some beads."""
    return case.solutes is not None and bool(case.solutes.magnetic)


def closed_axes(case: Case) -> set[int]:
    """Axes that plates close."""
    return {AXES.index(axis) for axis in walls.closed_axes(case.walls)}


def obstructed(case: Case) -> bool:
    """Whether there are solids other than the plates of a slit."""
    return bool(case.walls) and slit_of(case) is None


def quiet_axes(case: Case) -> tuple[int, ...]:
    """Axes that no wall closes and along which nothing flows."""
    unwalled = sorted({*range(case.box.dimension)} - closed_axes(case))
    return tuple(axis for axis in unwalled if flow(case, axis).kind == "rest")


class Flow(NamedTuple):
    """The steady velocity along one axis as a function of the coordinate along another.

    `profile` maps coordinates to velocities, None where there is no theory; `kind` names it.
    """

    kind: str
    across: int
    profile: Callable[[Array], Array] | None

    def bins(self, axis: int, edges: Array) -> Array | None:
        """Mean velocity in each bin along `axis`, (bins,); None without theory."""
        if self.profile is None:
            return None
        if axis != self.across:
            return np.full(len(edges) - 1, np.nan)
        return bin_average(self.profile, edges)


def bin_average(function: Callable[[Array], Array], edges: Array) -> Array:
    """Average of a smooth function over each bin, (bins,); exact for polynomials up to x^5."""
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    points = middle[:, None] + half[:, None] * _NODES
    return np.asarray(function(points.ravel()).reshape(points.shape) @ _WEIGHTS / 2)


def flow(case: Case, component: int) -> Flow:
    """The steady flow along axis number `component`."""
    box, plates = case.box, slit_of(case)
    rest = Flow("rest", 1, np.zeros_like)
    if plates is None and case.walls:
        return Flow("round solids", 1, None) if driven(case) else rest
    if plates and not (box.sheared and plates.lower.rule == plates.upper.rule == "slip"):
        return _slit(case, plates, component)
    if box.sheared:
        if case.fluid.force.acts or held_along(case, "x"):
            return Flow("driven shear", 1, None)
        if component != 0:
            return rest
        if not box.steady_rate:
            return Flow("oscillating shear" if box.oscillation else "changing shear", 1, None)
        rate, length = box.steady_rate, float(box.size[1])
        return Flow("lees-edwards", 1, lambda y: theory.lees_edwards_velocity(y, length, rate))
    force = case.fluid.force
    if force.uniform(box.dimension) is None:
        known = transport(case)
        return Flow(*force.steady_flow(component, box.size, known.viscosity if known else None))
    return Flow("accelerating", 1, None) if uniform_acceleration(case)[component] else rest


def flowing_axes(case: Case) -> list[Axis]:
    """Axes along which the steady flow goes, or may go where there is no theory of it."""
    found = []
    for i, axis in enumerate(case.box.axes):
        _, across, profile = flow(case, i)
        if profile is None or np.any(profile(np.linspace(0, case.box.size[across], 201))):
            found.append(axis)
    return found


def surface_velocity(surface: object, component: int) -> float:
    """Velocity of a plate along one axis."""
    velocity = getattr(surface, "velocity", None)
    return float(velocity[component]) if velocity else 0.0


def surface_speed(case: Case) -> float:
    """Speed of the fastest place on a solid; no place in the fluid that it drags is faster."""
    motion = solids_of(case).motion.values() if obstructed(case) else ()
    return max((speed for speed, _ in motion), default=0.0)


def _slit(case: Case, wall: Plates, component: int) -> Flow:
    across = AXES.index(wall.axis)
    if case.box.sheared:  # no-slip plates across the vorticity hold it back
        return Flow("sheared slit", across, None)
    if component == across:
        return Flow("rest", across, np.zeros_like)
    height = float(case.box.size[across])
    acceleration_along = float(uniform_acceleration(case)[component])
    lower, upper = (surface_velocity(s, component) for s in (wall.lower, wall.upper))
    sticky = [s.rule == "no-slip" for s in (wall.lower, wall.upper)]
    force = case.fluid.force
    if force.uniform(case.box.dimension) is None and force.drives(component):
        return Flow(f"{name_of(force)} slit", across, None)
    if not any(sticky):
        return Flow("plug", across, None if acceleration_along else np.zeros_like)
    if not acceleration_along:
        kind = "couette" if lower != upper and all(sticky) else "rest"
        lower, upper = (lower if sticky[0] else upper), (upper if sticky[1] else lower)
        return Flow(kind, across, lambda y: theory.couette_velocity(y, height, upper, lower))
    coefficients = transport(case)
    if coefficients is None:
        return Flow("poiseuille", across, None)
    nu = coefficients.viscosity
    if all(sticky):
        return Flow(
            "poiseuille",
            across,
            lambda y: (
                theory.couette_velocity(y, height, upper, lower)
                + theory.poiseuille_velocity(y, height, acceleration_along, nu)
            ),
        )

    # a slip plate is the middle of a slit twice as high
    def half(y: Array) -> Array:
        distance = y if sticky[0] else height - y
        wall_speed = lower if sticky[0] else upper
        return wall_speed + theory.poiseuille_velocity(distance, 2 * height, acceleration_along, nu)

    return Flow("half poiseuille", across, half)


def across_the_flow(case: Case, component: str | None) -> Iterator[str]:
    """A warning of an observable whose velocity component is not along the flow."""
    flowing = flowing_axes(case)
    if component is not None and flowing and component not in flowing:
        yield (
            f"component = {component!r}: nothing flows along {component}; "
            f"the flow is along {' and '.join(flowing)}"
        )
