"""The particles of a case: those of the fluid, beads of solutes, then bodies."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.trajectory import Group, Kind
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.body.drawn import drawn_as
from mesokit.method.mpcd.body.protocol import named
from mesokit.seam.method import BodyShape

Floats = NDArray[np.float64]
OF_BODIES = ("position", "velocity", "spin", "orientation", "image", "id")


def groups(case: Case) -> tuple[Group, ...]:
    """The fluid, species by species, its solutes, polymer by polymer, and bodies, if there are any.

    The fluid has its density times its volume (`fluid_volume`), of each species. Of molecules
    there is a whole number, and of a random solvent none.
    """
    kT = float(case.fluid.kT)
    found = [Group("fluid", _fluid(case), kT=kT), Group("solutes", _solutes(case), kT=kT)]
    if case.bodies:
        found.append(Group("bodies", _bodies(case), OF_BODIES, kT))
    return tuple(found)


def _solutes(case: Case) -> tuple[Kind, ...]:
    solutes, kinds = case.solutes, []
    for i, polymer in enumerate(solutes.polymers if solutes is not None else ()):
        # beads have a diameter if they feel one another, others, or else the fluid
        pairs, repelled = (solutes.own_pair(i), *solutes.pairs[i]), solutes.solvent_pair
        sizes = [pair.diameter for pair in pairs if pair is not None]
        sizes += [2.0 * repelled.diameter] if repelled is not None else []
        number = polymer.number * polymer.length
        kinds.append(Kind(solutes.mass_of(i), number, solutes.names[i], *sizes[:1]))
    return tuple(kinds)


def _bodies(case: Case) -> tuple[Kind, ...]:
    d, density = case.box.dimension, fluid_mass_density(case)
    found = []
    for name, kind in named(case.bodies):
        solid = kind.solid(d)
        shape, mass = drawn_as(solid.parts, d), kind.mass_in(d, density)
        inertia = _moments(mass / solid.volume * solid.moments, d)
        found.append(Kind(mass, kind.number, name, 2.0 * solid.radius, shape, inertia))
    return tuple(found)


def _moments(inertia: Floats, dimension: int) -> tuple[float, float, float] | None:
    """Of a body about its own axes, None unless those are principal ones; in 2D about z alone."""
    x, y, z = np.diag(inertia).tolist()
    if dimension == 2:
        return 0.0, 0.0, z
    return (x, y, z) if abs(inertia - np.diag([x, y, z])).max() <= 1e-9 * max(x, y, z) else None


def body_shapes(case: Case) -> tuple[BodyShape, ...]:
    """Shapes of all kinds of bodies, for pictures."""
    d, found = case.box.dimension, []
    for kind in case.bodies:
        solid = kind.solid(d)
        found.append(BodyShape(solid.parts, solid.radius, kind.forward(d)))
    return tuple(found)


def fluid_mass_density(case: Case) -> float:
    """Mass of the fluid per volume, without solutes."""
    return float(sum(kind.density * kind.mass for kind in case.fluid.kinds))


def _fluid(case: Case) -> tuple[Kind, ...]:
    fluid = case.fluid
    if case.solutes is not None and case.solutes.solvent == "random":
        return (Kind(fluid.mass, 0),)
    volume = fluid_volume(case)
    if fluid.molecule is not None:
        length = fluid.molecule.length
        return (Kind(fluid.mass, length * round(fluid.density * volume / length)),)
    return tuple(Kind(kind.mass, round(kind.density * volume)) for kind in fluid.kinds)


def fluid_volume(case: Case) -> float:
    """Volume that walls and bodies leave to the fluid, less what beads exclude that push it away.

    The fluid has its density far from them then. Where they overlap they exclude less.
    """
    solutes, d = case.solutes, case.box.dimension
    volume = free_volume(case) - sum(kind.number * kind.solid(d).volume for kind in case.bodies)
    if solutes is None or solutes.solvent_pair is None:
        return volume
    return volume - solutes.beads * solutes.excluded_volume(d, case.fluid.kT)


def bonded_pairs(case: Case) -> NDArray[np.int64]:
    """Numbers of particles (bonds, 2) that are linked: in molecules of the fluid and in solutes."""
    found, molecule = [np.zeros((0, 2), np.int64)], case.fluid.molecule
    if molecule is not None:
        starts = np.arange(0, case.particles, molecule.length)
        links = starts[:, None, None] + np.array(molecule.bonds, np.int64)
        found.append(links.reshape(-1, 2))
    if case.solutes is not None:
        found.append(case.particles + case.solutes.bonds())
    return np.concatenate(found)
