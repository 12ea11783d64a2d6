"""A kind of bodies that an observable follows, and what theory knows of it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import one_of, show
from mesokit.errors import CaseError
from mesokit.geometry.primitive import ROUND
from mesokit.geometry.region import Part
from mesokit.method.mpcd.body.protocol import named
from mesokit.method.mpcd.columns import holds, kinds_of_bodies, total_mass, turns
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.groups import fluid_mass_density

Floats = NDArray[np.float64]
KIND_OF_BODY = "which kind of bodies: name or number, from 1"
WIDE = 0.45  # of the side of a box: radius of a disk up to which its friction is known
SLENDER = 20.0  # longest rods whose friction is known, in diameters
SLOW = {2: 0.01, 3: 0.1}  # largest U d/nu of a dumbbell at which inertia takes a few per cent
ROUNDING = 1e-12  # of a moment of inertia


class Estimates(NamedTuple):
    """Speed of swimming or of a force, diffusion coefficient, Reynolds number of that speed and the
    radius, and the time R^2/D."""

    speed: float
    diffusion: float
    reynolds: float
    time: float


def revolves_about_x(part: Part) -> bool:
    """Whether a primitive is a body of revolution about axis x of its frame."""
    across = (*part.numbers[1:3], *part.numbers[4:6])
    return ROUND[part.code] and not np.any(np.abs(across) > ROUNDING)


class Followed(NamedTuple):
    """Bodies of one kind: its place among the kinds, its name, and the rows of its bodies.

    `moments` (3,) are the principal moments of inertia, about `axes` (3, 3), columns in the body's
    frame: its own axes where they are principal ones.
    """

    case: Case
    place: int
    name: str
    kind: Any
    rows: slice
    mass: float
    moments: Floats
    axes: Floats

    @property
    def number(self) -> int:
        """How many bodies."""
        return self.rows.stop - self.rows.start

    @property
    def turning(self) -> tuple[int, ...]:
        """Axes, of three, about which they turn freely: in 2D about z alone.

        None of balls with a slip surface, whose spin nothing changes.
        """
        dimension = self.case.box.dimension
        if self.untouched == (0, 1, 2) or (self.kind.hinge is not None and dimension == 3):
            return ()
        return ((), (2,), (), (0, 1, 2))[turns(self.kind, dimension)]

    @property
    def untouched(self) -> tuple[int, ...]:
        """Own axes about which no hit turns them: a slip surface pushes along its normal, through
        the centre of a ball and through the axis of a body of revolution."""
        if self.kind.surface != "slip":
            return ()
        if self.ball:
            return (0, 1, 2)
        parts = self.kind.solid(self.case.box.dimension).parts
        about_x = all(revolves_about_x(part) for part in parts)
        return (0,) if self.case.box.dimension == 3 and about_x else ()

    @property
    def ball(self) -> bool:
        """Whether they are disks or spheres."""
        return bool(self.kind.solid(self.case.box.dimension).ball)

    @property
    def any_direction(self) -> bool:
        """Whether, as far as they are concerned, all directions are alike: balls that turn freely
        about every axis."""
        held = self.kind.trap is not None and self.kind.trap.angular > 0
        return self.ball and not held and len(self.turning) == (1, 3)[self.case.box.dimension - 2]

    @property
    def moving(self) -> tuple[int, ...]:
        """Axes along which they move freely."""
        return tuple(k for k, name in enumerate(self.case.box.axes) if name not in self.kind.fixed)

    @property
    def thermal(self) -> bool:
        """Whether they are in equilibrium with a fluid at rest."""
        return not setting.driven(self.case)

    @property
    def free_share(self) -> float:
        """1 - M/M_all where the momentum of all is 0 and kept, else 1."""
        if self.case.walls or holds(self.case):
            return 1.0
        number = sum(group.number for group in self.case.groups)
        return 1.0 - self.mass / total_mass(self.case, number)

    def with_start(self, error: float, value: float, runs: int = 1) -> float:
        """The error of a number that grows as kT, with what the starts of so many runs add.

        Virtual particles bring a fluid that keeps its energy to kT, but slowly.
        """
        return setting.with_start(self.case, error, value, runs)

    # What theory knows, nan where it knows nothing: a value and a note on it.

    def velocity_square(self) -> float:
        """Mean square of a component of the velocity."""
        kT = float(self.case.fluid.kT)
        return kT / self.mass * self.free_share if self.thermal and self.moving else math.nan

    def spin_square(self) -> float:
        """Mean square of a component of the angular velocity, the mean over its axes."""
        if not (self.thermal and self.turning):
            return math.nan
        kT = float(self.case.fluid.kT)
        return float(np.mean([kT / self.moments[k] for k in self.turning]))

    def diffusion(self) -> tuple[float, str]:
        """Diffusion coefficient of the centres in this box."""
        mobility, why = self.mobility()
        return (float(self.case.fluid.kT) * mobility, why) if self.thermal else (math.nan, "")

    def carried(self, turns: bool) -> str:
        """A note where a force, a torque or swimming moves them as well; "" where none does."""
        if not turns and self.kind.swim is not None:
            return "swimming is in it"
        acts = np.any((self.kind.torque if turns else self.kind.force) or 0.0)
        return "the drift is in it" if acts else ""

    def rotational_diffusion(self) -> tuple[float, str]:
        """Rotational diffusion coefficient."""
        mobility, why = self.rotational_mobility()
        return (float(self.case.fluid.kT) * mobility, why) if self.thermal else (math.nan, "")

    def memory(self, time: NDArray[np.float64], turns: bool) -> NDArray[np.float64] | None:
        """Correlation of a component of the velocity, or angular velocity, of one free sphere: drag
        with the memory of the fluid, in this box. nan until sound has passed it.

        None of anything else, and of turning where the stress is not symmetric.
        """
        known, coefficients = self.alone_in_a_cube(), setting.solvent(self.case)
        free = len(self.turning if turns else self.moving) == 3 and self.thermal and not self.held
        driven = self.kind.swim or self.kind.counter or holds(self.case)
        if known is None or coefficients is None or not free or driven:
            return None
        if turns and self.asymmetric_share:
            return None
        radius, length, _ = known
        fluid, nu, rho = self.case.fluid, coefficients.viscosity, fluid_mass_density(self.case)
        found = np.full(len(time), math.nan)
        late = time > radius / coefficients.sound_speed
        t, kT = time[late], float(fluid.kT)
        if not late.any():
            return found
        if turns:
            inertia = float(self.moments[0])
            found[late] = theory.sphere_angular_vacf(t, radius, nu, rho, inertia, kT)
            return found
        alone = theory.sphere_vacf(t, radius, nu, rho, self.mass, kT)
        in_box = theory.vacf_modes(t, nu, 0.0, rho, [length] * 3, kT)
        found[late] = alone + in_box - theory.vacf_tail(t, nu, 0.0, rho, 3, kT)
        return found

    def memory_holds(self) -> tuple[float, float]:
        """The first and the last time of the comparison: R^2/nu and L^2/(4 pi^2 nu)."""
        known, coefficients = self.alone_in_a_cube(), setting.solvent(self.case)
        if known is None or coefficients is None:
            return math.inf, 0.0
        radius, length, _ = known
        nu = coefficients.viscosity
        return radius**2 / nu, length**2 / (4 * math.pi**2 * nu)

    @property
    def trapped(self) -> bool:
        """Whether springs hold them to places."""
        return self.kind.trap is not None and self.kind.trap.k > 0

    @property
    def held(self) -> bool:
        """Whether springs hold them to places that do not slide past one another."""
        return self.trapped and bool(self.moving) and not self.case.box.sheared

    def trapped_square(self) -> tuple[float, str]:
        """Mean square distance from a trap along one axis, by Boltzmann's distribution."""
        variance = 1.0 / self.kind.trap.k  # stiffness is in kT/a^2
        if not self.thermal or 36.0 * variance > min(self.case.box.size) ** 2:
            return math.nan, ""
        near = bool(self.case.walls) or sum(kind.number for kind in self.case.bodies) > 1
        return variance, "approximate: as if no wall or other body were near" if near else ""

    def mobility(self) -> tuple[float, str]:
        """Velocity over force in this box."""
        known = self.alone_in_a_cube()
        if known is None or self.kind.swim or self.kind.counter or holds(self.case):
            return math.nan, ""
        radius, length, viscosity = known
        friction = theory.sphere_friction_in_cube
        if self.case.box.dimension == 2:
            friction = theory.disk_friction_in_square
        slip, why = self.slip
        light = 1.0 - (self.mass - self.displaced) / total_mass(self.case, self.all_moving)
        return light**2 / friction(radius, length, viscosity, slip), why

    def rotational_mobility(self) -> tuple[float, str]:
        """Angular velocity over torque."""
        known = self.alone_in_a_cube()
        if known is None or self.kind.swim or self.kind.counter or not self.turning:
            return math.nan, ""
        (radius, length, viscosity), (slip, why) = known, self.slip
        d, share = self.case.box.dimension, self.asymmetric_share
        if share:
            why = f"{why}; the limit of a large body, as the rule turns it too easily"
        return 1.0 / theory.rotational_friction(radius, viscosity, d, length, slip, share), why

    def swimming_speed(self) -> tuple[float, str]:
        """Speed of a squirmer, or of a body with a counter-force, along its own axis."""
        known, kind = self.alone_in_a_cube(), self.kind
        if known is None or holds(self.case):
            return math.nan, ""
        (radius, length, viscosity), (slip, why) = known, self.slip
        d, force, beside = self.case.box.dimension, kind.force or (0.0,), kind.counter
        if kind.swim is None and beside is not None and beside.at is not None:
            far, ball = abs(beside.at[0]), beside.radius
            if any(force[1:]) or any(beside.at[1:]) or far < radius + ball:
                return math.nan, ""
            speed = theory.dumbbell_speed(
                force[0], radius, far, viscosity, length, d, counter_radius=ball, slip=slip
            )
            speed *= 1.0 - (self.mass - self.displaced) / total_mass(self.case, self.all_moving)
            reynolds = abs(speed) * far * fluid_mass_density(self.case) / viscosity
            if reynolds > SLOW[d]:
                why = why.removeprefix("approximate: ")
                why = f"approximate: without inertia, but U d/nu is {reynolds:.2g}; {why}"
            return speed, why
        if kind.swim is None or any(force):
            return math.nan, ""
        speed, fraction = theory.squirmer_speed(kind.swim.B1, d), kind.solid(d).volume / length**d
        share = self.asymmetric_share
        return theory.squirmer_speed_in_box(speed, fraction, slip / radius, share), why

    # Estimates before a run: in 3D of one alone, in 2D of a lattice.

    def roughly(self) -> Estimates:
        """Speed, diffusion and what follows from them; nan where theory has no number."""
        d, coefficients = self.case.box.dimension, setting.solvent(self.case)
        if coefficients is None or self.kind.surface != "no-slip":
            return Estimates(math.nan, math.nan, math.nan, math.nan)
        solid, viscosity = self.kind.solid(d), coefficients.viscosity
        mobility = self._rough_mobility(viscosity * fluid_mass_density(self.case))
        free = [axis not in self.kind.fixed for axis in self.case.box.axes]
        force = np.array(self.kind.force or 0.0) * (1.0 if self.kind.frame == "body" else free)
        speed = float(np.linalg.norm(force)) * mobility if force.any() else 0.0
        if speed > 0 and self.kind.counter is not None and self.kind.counter.at is not None:
            eta = viscosity * fluid_mass_density(self.case)
            speed *= 1.0 - self._carried_back(force, mobility, eta)
        if self.kind.swim is not None:
            speed += abs(theory.squirmer_speed(self.kind.swim.B1, d, self.kind.aspect))
        if not any(free) or self.trapped:
            speed = 0.0
        diffusion = float(self.case.fluid.kT) * mobility
        return Estimates(
            speed, diffusion, speed * solid.radius / viscosity, solid.radius**2 / diffusion
        )

    def _carried_back(self, force: NDArray[np.float64], mobility: float, viscosity: float) -> float:
        """The part of the speed of a ball that a counter-force takes which acts on its line; 0
        elsewhere."""
        d, counter = self.case.box.dimension, self.kind.counter
        solid = self.kind.solid(d)
        at, strength = np.array(counter.at), float(np.linalg.norm(force))
        far = float(np.linalg.norm(at))
        in_line = abs(force @ at) > (1.0 - 1e-9) * far * strength
        if not (solid.ball and in_line and far >= solid.radius + counter.radius):
            return 0.0
        side = math.sqrt(self.case.box.volume / self.number) if d == 2 else math.inf
        speed = theory.dumbbell_speed(
            strength, solid.radius, far, viscosity, side, d, counter_radius=counter.radius
        )
        return 1.0 - speed / (strength * mobility)

    def _rough_mobility(self, viscosity: float) -> float:
        """Mean velocity over force of disks as in a lattice, or of one sphere, spheroid or rod."""
        case, kind, solid = self.case, self.kind, self.kind.solid(self.case.box.dimension)
        if case.box.dimension == 2:
            side = math.sqrt(case.box.volume / self.number)
            if not solid.ball or solid.radius > WIDE * side:
                return math.nan
            return 1.0 / theory.disk_friction_in_square(solid.radius, side, viscosity)
        if solid.ball:
            return 1.0 / (6.0 * math.pi * viscosity * solid.radius)
        if (half := getattr(kind, "half_length", None)) is not None:
            friction = theory.ellipsoid_friction((half, kind.radius, kind.radius), viscosity)
            return float(np.mean(1.0 / friction.translation))
        length, radius = getattr(kind, "length", math.nan), getattr(kind, "radius", math.nan)
        if not 1.0 <= 0.5 * length / radius <= SLENDER:
            return math.nan
        rod = theory.capsule_friction(length, 2.0 * radius, viscosity)
        return (1.0 / rod.along + 2.0 / rod.across) / 3.0

    @property
    def asymmetric_share(self) -> float:
        """The share of the viscosity that does not conserve angular momentum."""
        coefficients = setting.solvent(self.case)
        if "angular momentum" in self.case.fluid.collision.conserves or coefficients is None:
            return 0.0
        return coefficients.viscosity_collisional / coefficients.viscosity

    @property
    def all_moving(self) -> int:
        """Number of particles and bodies."""
        return sum(group.number for group in self.case.groups)

    @property
    def displaced(self) -> float:
        """Mass of the fluid in the place of a body."""
        volume = self.kind.solid(self.case.box.dimension).volume
        return fluid_mass_density(self.case) * volume

    def alone_in_a_cube(self) -> tuple[float, float, float] | None:
        """Radius, side and dynamic viscosity of a single no-slip ball in a periodic cube or square
        at rest, without solutes; None of anything else."""
        case, d = self.case, self.case.box.dimension
        solid, coefficients = self.kind.solid(d), setting.solvent(case)
        alone = len(case.bodies) == self.number == 1 and solid.ball and case.solutes is None
        still = not (case.walls or case.box.sheared or case.fluid.force.acts)
        sticks = self.kind.surface == "no-slip" and len(set(case.box.size)) == 1
        if not (alone and still and sticks) or coefficients is None:
            return None
        viscosity = coefficients.viscosity * fluid_mass_density(case)
        return solid.radius, float(case.box.size[0]), viscosity

    @property
    def slip(self) -> tuple[float, str]:
        """The slip length of its surface, and a note on where it is from.

        Between mean free paths it is interpolated (docs/validation/wall_slip.md).
        """
        place, source = (self.case.box.dimension, self.kind.virtual), "plates in SRD"
        lengths = SLIP_LENGTHS[place]
        if place in SLIP_OF_TURNING and "angular momentum" in self.case.fluid.collision.conserves:
            lengths, source = SLIP_OF_TURNING[place], "balls that turn"
        path = np.log(setting.mean_free_path(self.case))
        slip = float(np.exp(np.interp(path, np.log(PATHS), np.log(lengths))))
        why = f"with a slip length of {slip:.2g} a, as of {source}"
        if part := setting.short_flights(self.case):
            why = f"approximate: short flights take up to {100 * part:.0f} % off a viscosity; {why}"
        elif lengths is SLIP_OF_TURNING.get(place) and path > np.log(LONGEST_TURNING):
            why = f"approximate: no slip was measured at so long a mean free path; {why}"
        return slip, why


# Mean free paths, and slip lengths of plates in SRD that were measured there. In 2D those of 0.1
# alone, the others in proportion to 3D.
PATHS = (0.02, 0.1, 0.5)
SLIP_LENGTHS = {
    (3, "fill"): (0.242, 0.151, 0.080),
    (3, "none"): (5.797, 0.928, 0.049),
    (2, "fill"): (0.353, 0.220, 0.117),
    (2, "none"): (8.25, 1.320, 0.070),
}
LONGEST_TURNING = 0.15  # the longest mean free path near which that of balls was measured
# With rules that conserve angular momentum, of spheres and disks that turn. At 0.02 of AT+a, with
# the measured viscosity (docs/validation/bodies_slow_flow.md); at 0.1 the mean of two rules with
# that of molecular chaos, and the speed of swimmers, which needs none, gives the same
# (docs/validation/bodies_in_flow.md); at 0.5 not measured, but in proportion to plates.
SLIP_OF_TURNING = {(3, "fill"): (0.128, 0.046, 0.024), (2, "fill"): (0.158, 0.075, 0.040)}


def followed(case: Case, quantity: str, kind: int | str = 1) -> Followed:
    """A kind of bodies, by its name or number from 1. Raises CaseError where there is none."""
    if not case.bodies:
        raise CaseError(f"{quantity} needs bodies that move in the fluid; give [[bodies]]")
    names = [one.name for one in named(case.bodies)]
    if kind in names:
        place = names.index(str(kind))
    elif isinstance(kind, int) and 1 <= kind <= len(names):
        place = kind - 1
    else:
        known = one_of([*names, *range(1, len(names) + 1)])
        raise CaseError(f"kind = {show(kind)}: expected {known}")
    numbers = [one.number for one in case.bodies]
    first, mass = sum(numbers[:place]), kinds_of_bodies(case)[place].mass
    solid = case.bodies[place].solid(case.box.dimension)
    inertia = mass / solid.volume * solid.moments
    moments, axes = np.diag(inertia), np.eye(3)
    if abs(inertia - np.diag(moments)).max() > ROUNDING * moments.max():
        moments, axes = np.linalg.eigh(inertia)
    rows = slice(first, first + numbers[place])
    return Followed(case, place, names[place], case.bodies[place], rows, mass, moments, axes)


def every_kind(case: Case, quantity: str) -> list[Followed]:
    """All kinds of bodies. Raises CaseError where there are none."""
    return [followed(case, quantity, number) for number in range(1, max(len(case.bodies), 1) + 1)]
