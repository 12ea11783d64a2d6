"""Particles as another program has written them, and whether they are those of a case."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.conformation import connected

Numbers = NDArray[np.int64]
SHOWN = 4  # sizes of molecules that a message lists


def bead_order(bonds: Numbers, particles: int, molecule: Molecule) -> Numbers:
    """The particle (particles,) that is each bead, molecule by molecule as `molecule` counts them.

    Molecules come in the order of their lowest particle; a chain begins at its lower end, a ring
    goes from its lowest particle to that one's lower neighbour, arms of a star come in the order
    of their innermost beads. Particles that are in order stay where they are.

    Parameters: `bonds` (bonds, 2), numbers of the particles that are linked, from 0. Raises
    CaseError unless these are the bonds of such molecules and no others.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    links = np.unique(np.sort(bonds, axis=1), axis=0)
    graph = coo_matrix((np.ones(len(links)), links.T), shape=(particles, particles))
    count, member = connected_components(graph, directed=False)
    sizes = np.unique(np.bincount(member))
    if sizes.tolist() != [molecule.length]:
        shown = ", ".join(map(str, sizes[:SHOWN])) + ", ..." * (len(sizes) > SHOWN)
        raise CaseError(
            f"its bonds make molecules of {shown} particles; expected {molecule.length} in each "
            "(fluid.molecule.length)"
        )
    ends = np.concatenate([links, links[:, ::-1]])
    ends = ends[np.lexsort(ends.T[::-1])]
    degree = np.bincount(ends[:, 0], minlength=particles)
    wanted = np.sort(np.bincount(np.ravel(molecule.bonds), minlength=molecule.length))
    there = degree[np.lexsort((degree, member))].reshape(-1, molecule.length)
    arms = f" with {molecule.arms} arms of one length" if molecule.arms else ""
    other_bonds = CaseError(
        f"its bonds differ from those of the case; expected each molecule to be a "
        f"{molecule.topology} of {molecule.length} beads{arms} (fluid.molecule)"
    )
    if not (there == wanted).all():
        raise other_bonds
    neighbours = np.full((particles, max(2, int(degree.max()))), -1)
    column = np.arange(len(ends)) - np.repeat(np.cumsum(degree) - degree, degree)
    neighbours[ends[:, 0], column] = ends[:, 1]

    first = np.full(count, particles)
    np.minimum.at(first, member, np.arange(particles))
    begin = np.full(count, particles)
    star = molecule.topology == "star" and molecule.arms is not None and molecule.arms > 2
    bonds_of_first = molecule.arms if star else 2 if molecule.topology == "ring" else 1
    starts = np.flatnonzero(degree == bonds_of_first)
    np.minimum.at(begin, member[starts], starts)
    order = _beads(neighbours, begin[np.argsort(first)], molecule)
    found = order[:, np.array(molecule.bonds)].reshape(-1, 2)
    if not np.array_equal(np.unique(np.sort(found, axis=1), axis=0), links):
        raise other_bonds
    return order.ravel()


def _beads(neighbours: Numbers, begin: Numbers, molecule: Molecule) -> Numbers:
    """Particles (molecules, length) in the order of the beads, from the one to begin at on."""
    arms = molecule.arms or 1
    if arms > 2:
        inner = neighbours[begin, :arms].T
        steps = (molecule.length - 1) // arms
        return np.concatenate(
            [begin[:, None], *(_path(neighbours, begin, bead, steps) for bead in inner)], axis=1
        )
    rest = _path(neighbours, begin, neighbours[begin, 0], molecule.length - 1)
    path = np.concatenate([begin[:, None], rest], axis=1)
    if arms == 2:  # a chain that is counted from its middle
        middle = molecule.length // 2
        path = np.concatenate([path[:, middle::-1], path[:, middle + 1 :]], axis=1)
    return path


def _path(neighbours: Numbers, before: Numbers, here: Numbers, steps: int) -> Numbers:
    """So many particles (molecules, steps) along a line of bonds, away from the one before."""
    path = [here]
    for _ in range(steps - 1):
        one, other = neighbours[here, 0], neighbours[here, 1]
        before, here = here, np.where(one == before, other, one)
        path.append(here)
    return np.stack(path, axis=1)


Floats = NDArray[np.float64]
ROUNDING = 1e-5  # relative, of numbers in single precision and in texts


def fitted(case: Case, there: Snapshot) -> tuple[Floats, Floats | None]:
    """Positions and velocities (n, d) by the particle ids of the case, from the corner of its box.

    Raises CaseError unless box, number, masses and bonds are those of the case.
    """
    d, n = case.box.dimension, len(there.positions)
    require_box(case, there)
    if n != case.particles:
        hint, density, molecule = "", case.fluid.density, case.fluid.molecule
        whole = molecule is None or n % molecule.length == 0
        if whole and case.particles and not case.fluid.species:
            hint = f"; fluid.density = {show(density * n / case.particles)} makes so many"
        raise CaseError(
            f"it has {n} particles, this case {case.particles} "
            f"(fluid.density = {show(density)}){hint}"
        )
    order = _by_mass(case, there)
    if case.fluid.molecule is not None:
        if not len(there.bonds):
            raise CaseError("it has no bonds; expected those of fluid.molecule")
        order = bead_order(there.bonds, n, case.fluid.molecule)
        places = _whole(case, there)
    else:
        if len(there.bonds):
            raise CaseError(f"it has {len(there.bonds)} bonds, this case no fluid.molecule")
        places = (there.positions - there.low)[:, :d]
    velocities = None if there.velocities is None else there.velocities[order, :d]
    return places[order], velocities


def fitted_beads(case: Case, there: Snapshot) -> tuple[Floats, Floats | None]:
    """The same for the beads of solutes. Several kinds of molecules must be in the case's order."""
    assert case.solutes is not None
    solutes, d, n = case.solutes, case.box.dimension, len(there.positions)
    require_box(case, there)
    if n != solutes.beads:
        raise CaseError(f"it has {n} particles, this case {solutes.beads} beads of solutes")
    if there.masses is not None:
        wanted = np.array(solutes.masses)[solutes.kinds()]
        off = ~np.isclose(there.masses, wanted, rtol=ROUNDING, atol=0)
        if off.any():
            one = int(np.argmax(off))
            raise CaseError(
                f"particle {there.numbers[one]} has mass {there.masses[one]:.6g}; expected "
                f"{wanted[one]:.6g} (solutes.mass)"
            )
    molecule = solutes.molecule(0)
    if len(solutes.polymers) == 1 and molecule is not None and molecule.topology != "free":
        if not len(there.bonds):
            raise CaseError("it has no bonds; expected those of solutes.polymers")
        order = bead_order(there.bonds, n, molecule)
    else:
        order, links = np.arange(n), np.sort(solutes.bonds(), axis=1)
        found = np.unique(np.sort(there.bonds.reshape(-1, 2), axis=1), axis=0)
        if not np.array_equal(found, np.unique(links, axis=0).reshape(-1, 2)):
            raise CaseError(
                "its bonds are not those of solutes.polymers, kind after kind, bead after bead"
            )
    places = _whole(case, there)[order]
    if there.images is None:  # each bead in the image that is nearest to the one it is linked to
        closed = {*closed_axes(case.walls), *case.box.open}
        unbounded = [axis in closed for axis in case.box.axes]
        periods = np.where(unbounded, np.inf, np.array(case.box.size, float))
        for kind, polymer in enumerate(solutes.polymers):
            molecule, first = solutes.molecule(kind), solutes.first_bead(kind)
            part = slice(first, first + polymer.number * polymer.length)
            if molecule is not None:
                places[part] = connected(places[part], molecule, periods)
    velocities = None if there.velocities is None else there.velocities[order, :d]
    return places, velocities


def require_box(case: Case, there: Snapshot) -> None:
    """Raise CaseError for other lengths, no right angles, or in 2D particles not in one plane."""
    d, size = case.box.dimension, np.array(case.box.size, float)
    if np.abs(there.tilts).max() > ROUNDING:
        raise CaseError(
            f"its box leans by {show(there.tilts.tolist())}; expected right angles, as images have "
            "not slid at the start"
        )
    if d == 2 and np.ptp(there.positions[:, 2]) > ROUNDING:
        raise CaseError("its particles differ in z; expected a 2D box as in this case")
    if not np.allclose(there.lengths[:d], size, rtol=ROUNDING, atol=0):
        raise CaseError(
            f"it has a box of {show(there.lengths[:d].tolist())}, this case {show(case.box.size)} "
            "(box.size)"
        )


def _by_mass(case: Case, there: Snapshot) -> NDArray[np.int64]:
    """The particle (n,) of the file for each particle id, so that kinds have their masses."""
    volume = free_volume(case)
    kinds = [(kind.mass, round(kind.density * volume)) for kind in case.fluid.species]
    masses, counts = zip(*kinds or [(case.fluid.mass, case.particles)], strict=True)
    wanted, order = np.repeat(masses, counts), np.arange(case.particles)
    if there.masses is None:
        if len(set(masses)) > 1:
            raise CaseError("it has no masses; expected those of fluid.species")
        return order
    order[np.argsort(wanted, kind="stable")] = np.argsort(there.masses, kind="stable")
    off = ~np.isclose(there.masses[order], wanted, rtol=ROUNDING, atol=0)
    if off.any():
        one = int(np.argmax(off))
        raise CaseError(
            f"particle {there.numbers[order[one]]} has mass {there.masses[order[one]]:.6g}; "
            f"expected {wanted[one]:.6g} as in this case"
        )
    return order


def _whole(case: Case, there: Snapshot) -> Floats:
    """Places (n, d), as if the box had no bounds where the file has their images.

    Raises CaseError for a bond so long that the images which it links are ambiguous.
    """
    d = case.box.dimension
    closed = {*closed_axes(case.walls), *case.box.open}
    open_axes = np.array([axis not in closed for axis in case.box.axes])
    size, places = there.lengths[:d], (there.positions - there.low)[:, :d]
    counted = there.images is not None and bool(there.images[:, :d][:, open_axes].any())
    if counted:
        assert there.images is not None
        places = places + np.where(open_axes, there.images[:, :d] * size, 0.0)
    separation = places[there.bonds[:, 1]] - places[there.bonds[:, 0]]
    if counted:
        far = (np.abs(separation) > 0.5 * size)[:, open_axes].any(axis=1)
    else:
        separation -= np.where(open_axes, np.rint(separation / size) * size, 0.0)
        far = np.linalg.norm(separation, axis=1) > 0.5 * size.min()
    if far.any():
        one = int(np.argmax(far))
        first, second = there.numbers[there.bonds[one]]
        raise CaseError(
            f"the bond of particles {first} and {second} is {np.linalg.norm(separation[one]):.4g} "
            f"long, more than half of the box {show(size.tolist())}; expected shorter bonds or a "
            "larger box"
        )
    return np.asarray(places)
