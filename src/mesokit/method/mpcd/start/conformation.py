"""How molecules lie at the start: bonds of the right temperature, everywhere in the fluid.

`thermal` bonds have lengths and angles of the temperature. `octant` bonds have each component
uniform in [0, s), with s such that their mean square length is that of the temperature: of right
size in the mean, but all in one octant, so that molecules are far from equilibrium for some
relaxation times. They are those of D. Toneian, diploma thesis, TU Wien (2015), section 4.2.2, to
compare with.
"""

import functools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.solute.free import spanning
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.topology import pairs
from mesokit.potential.protocol import angular, central
from mesokit.potential.thermal import lengths, mean_square

Floats = NDArray[np.float64]
TRIES = 500  # to place the molecules that do not fit where they were drawn
POINTS = 2001  # of the grid of angles
HOT = 20.0  # kT: beads of more energy are drawn again


def drawn(
    molecule: Molecule,
    kT: float,
    box: Floats,
    random: Draws,
    in_fluid: Callable[[Floats], NDArray[np.bool_]],
) -> Floats:
    """Places (particles, d) of the beads, molecule after molecule, whole: bonds may leave the box.

    `random` draws for each molecule. The first bead is anywhere in the box, the others follow bond
    by bond, with lengths and angles of the temperature (for harmonic bonds these are Gaussian), or
    as `octant` has them. Molecules that reach into a solid or have beads that repel one another
    strongly are drawn again. Raises RunError if that is in vain.
    """
    d, ring = len(box), molecule.topology == "ring"
    places = np.empty((len(random.ids), molecule.length, d))
    left = np.arange(len(places))
    for _ in range(TRIES):
        new = np.empty((len(left), molecule.length, d))
        new[:, 0] = random.units(d) * box
        bonds = np.stack([first_bonds(molecule, kT, d, random) for _ in molecule.bonds])
        if ring:
            bonds -= bonds.mean(axis=0)  # the last one leads back; Gaussian bonds stay Gaussian
        came: dict[int, int] = {}  # bond by which each bead was reached
        for n, (a, b) in enumerate(molecule.bonds[:-1] if ring else molecule.bonds):
            if molecule.bending is not None and a in came and not ring:
                bonds[n] = turned(molecule, bonds[came[a]], bonds[n], kT, random)
            new[:, b] = new[:, a] + bonds[n]
            came[b] = n
        good = in_fluid(new).all(axis=1) & _relaxed(molecule, new, kT)
        places[left] = new
        left, random = left[~good], random.of(~good)
        if len(left) == 0:
            return places.reshape(-1, d)
    raise RunError(
        f"fluid.molecule: no place for {len(left)} of {len(places)} molecules; they are too large "
        "for the room between the solids, or their beads too large for one another"
    )


def first_bonds(molecule: Molecule, kT: float, d: int, random: Draws) -> Floats:
    """A bond vector (n, d) for each, as the conformation has them, thermal but for angles."""
    if molecule.conformation == "octant":
        square = mean_square(molecule.bond_potentials, d, kT, molecule.bond.longest)
        return np.sqrt(3.0 * square / d) * random.units(d)
    spring = molecule.bond.spring()
    if spring is not None and molecule.pair is None:
        return np.sqrt(0.5 * kT / spring.K) * random.normals(d)
    radii, _, density = lengths(molecule.bond_potentials, d, kT, molecule.bond.longest)
    whole = np.cumsum(density)
    length = np.interp(random.units(1)[:, 0], whole / whole[-1], radii)
    return length[:, None] * _directions(d, random)


def _directions(d: int, random: Draws) -> Floats:
    vectors = random.normals(d)
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def turned(molecule: Molecule, before: Floats, bond: Floats, kT: float, random: Draws) -> Floats:
    """The bond, as long as it is, at an angle of the temperature to the one before."""
    assert molecule.bending is not None
    d = bond.shape[1]
    theta, whole = _angles(molecule.bending.kernel(), d, kT)
    angle = np.interp(random.units(1)[:, 0], whole / whole[-1], theta)
    along = before / np.linalg.norm(before, axis=1)[:, None]
    across = _directions(d, random)
    across -= (across * along).sum(axis=1)[:, None] * along
    across /= np.linalg.norm(across, axis=1)[:, None]
    direction = np.cos(angle)[:, None] * along + np.sin(angle)[:, None] * across
    return np.linalg.norm(bond, axis=1)[:, None] * direction


@functools.lru_cache(64, typed=True)  # potentials of other kinds may have the same numbers
def _angles(bending: object, d: int, kT: float) -> tuple[Floats, Floats]:
    """Angles, and how likely those below each are, but for a factor."""
    theta = np.linspace(0.0, np.pi, POINTS)
    energy = np.array([angular.plain(bending, c)[0] for c in np.cos(theta).tolist()])
    weight = np.sin(theta) ** (d - 2) * np.exp(-(energy - energy.min()) / kT)
    return theta, np.cumsum(weight)


def _relaxed(molecule: Molecule, places: Floats, kT: float) -> NDArray[np.bool_]:
    """Molecules none of whose beads have too much energy, by bonds not drawn by their energy (those
    that close a ring, and those of an octant) or by repulsion."""
    good = np.ones(len(places), bool)
    if molecule.pair is not None:
        limit = nearest_of(molecule.pair.kernel(), kT)
        for i, j in pairs(molecule.length):
            good &= np.linalg.norm(places[:, j] - places[:, i], axis=1) > limit
    if molecule.topology == "ring" or molecule.conformation == "octant":
        for a, b in molecule.bonds:
            length = np.linalg.norm(places[:, b] - places[:, a], axis=1)
            good &= length < 0.9 * molecule.bond.longest
    return good


@functools.lru_cache(64, typed=True)  # potentials of other kinds may have the same numbers
def nearest_of(pair: object, kT: float) -> float:
    """Distance at which two beads have the energy HOT."""
    radii = np.geomspace(1e-3, 1e3, POINTS)
    energy = np.array([central.plain(pair, r * r)[0] for r in radii.tolist()])
    hot = np.flatnonzero(energy > HOT * kT)
    return float(radii[hot[-1]]) if len(hot) else 0.0


def connected(places: Floats, molecule: Molecule, periods: Floats) -> Floats:
    """The same places, each bead in the image that is nearest to the one it hangs on."""
    whole = places.reshape(-1, molecule.length, places.shape[1]).copy()
    links = molecule.bonds[:-1] if molecule.topology == "ring" else molecule.bonds
    if molecule.topology == "free":
        links = spanning(molecule.bonds, molecule.length)
    for a, b in links:
        apart = whole[:, b] - whole[:, a]
        with np.errstate(invalid="ignore"):
            boxes = np.where(np.isinf(periods), 0.0, np.rint(apart / periods))
        whole[:, b] -= boxes * np.where(np.isinf(periods), 0.0, periods)
    return whole.reshape(places.shape)
