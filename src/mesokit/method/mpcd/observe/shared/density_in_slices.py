"""The density of an MPCD fluid, or of molecules in it, in slices."""

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import springs_of
from mesokit.method.mpcd.expected.selection import Group, group_of, kind_of
from mesokit.method.mpcd.expected.traps import held, squares_from_middle, trapped
from mesokit.observe.shared.profile import Array, Compared, ProfileAccumulator
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.estimate import Estimate
from mesokit.seam.result import Comparison

LABELS = {
    "particles": "density",
    "beads": "density of beads",
    "centres": "density of centres of mass",
    "ends": "density of end beads",
}


class DensityInSlices:
    """That of an ideal gas, of ideal molecules between plates, or of solutes in traps."""

    answers = "density-profile"
    width = 1
    ids: NDArray[np.int64] | None = None  # `group` says which count

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, self.of = case, observable.of
        self.label = LABELS[self.of]
        self.kind = 1 if observable.kind is None else observable.kind
        self.group = group_of(case, observable.of, observable.kind)
        self.everything = self.of == "particles" and not (case.fluid.species and observable.kind)
        molecule = self.group.molecule
        if self.of == "ends" and molecule and molecule.topology == "ring":
            raise CaseError("of = 'ends': rings have none")
        if self.of == "centres" and observable.axis == "x" and case.box.sheared:
            raise CaseError("of = 'centres': not along 'x' under shear, whose images slide")

    def sums(self, profile: ProfileAccumulator, fluid: RunningFluid) -> Array:
        """Number (1, bins) of what counts."""
        if self.everything:
            return profile.moments(fluid)[0][None]
        first, last = self.group.first, self.group.first + self.group.number * self.group.length
        slices = functools.partial(self.slices, profile)
        return fluid.sums_of_particles(slices, profile.bins, [1.0], first, last)

    def slices(self, profile: ProfileAccumulator, some: Some) -> Terms:
        """Slices of what counts among some molecules, each as one."""
        y, edges = some.positions[:, profile.axis], profile.edges
        if self.of == "centres":
            y = y + some.images[:, profile.axis] * edges[-1]
            y = y.reshape(-1, self.group.length).mean(axis=1)
            if profile.periodic:
                y = y % edges[-1]
        elif self.of == "ends":
            y = y.reshape(-1, self.group.length)[:, _ends(self.group)].ravel()
        place = np.searchsorted(edges, y, side="right") - 1
        place[y == edges[-1]] -= 1  # what lies at the very end is in the last
        place = place[(place >= 0) & (place < profile.bins)]
        return place, [np.ones(len(place))]

    def compared(self, profile: ProfileAccumulator, density: Estimate, sums: Array) -> Compared:
        """The profile, compared as a whole and next to each plate."""
        expected = self.expected(profile)
        found: list[Comparison] = []
        if expected is not None and profile.blocks.count:
            found = profile.chi_square(density, expected, "against theory")
            if self.trapped:
                found.append(self.spread(profile, density, expected))
            elif not profile.periodic:
                cell, unit = profile.observable.bins_per_cell, self.case.box.density_unit
                for name, part in (("lower", slice(0, cell)), ("upper", slice(-cell, None))):
                    mean = np.zeros(profile.bins)
                    mean[part] = 1 / cell
                    where, known = (
                        f"density in the cell at the {name} plate",
                        float(mean @ expected),
                    )
                    found.append(Comparison(where, *density.total(mean), known, unit))
        return Compared(expected, self.legend(profile), found)

    @property
    def trapped(self) -> bool:
        """Whether it is of solutes in traps."""
        return self.of != "particles" and trapped(self.case, self.kind)

    def spread(self, profile: ProfileAccumulator, density: Estimate, expected: Array) -> Comparison:
        """Mean square distance from the expected middle, by the shorter way round the box."""
        length, share = profile.edges[-1], expected / expected.sum()
        square = squares_from_middle(profile.centres, share, length) / expected.sum()
        what = f"mean square distance from the middle of the traps along {profile.observable.axis}"
        return Comparison(what, *density.total(square), square @ expected, "a^2")

    def legend(self, profile: ProfileAccumulator) -> str:
        """Name of the theory in a figure."""
        if self.trapped:
            return "Boltzmann in traps"
        walls = self.group.molecule is not None and not profile.periodic
        return "ideal molecules between walls" if walls else "ideal gas"

    def expected(self, profile: ProfileAccumulator) -> Array | None:
        """Uniform where nothing is in the way; else that of a gas or of ideal molecules."""
        case, group = self.case, self.group
        density = group.number * group.length / float(np.prod(case.box.size))
        if setting.obstructed(case) or setting.gathered(case):
            return None
        if self.trapped:
            return self.expected_in_traps(profile)
        acceleration = setting.uniform_acceleration(case)
        weight = 0.0 if profile.periodic else float(acceleration[profile.axis])
        solutes = None if group.first < case.particles else case.solutes
        kind = solutes.index_of(self.kind) if solutes else 0
        mass = solutes.masses[kind] if solutes else case.fluid.mass
        decay = mass * weight / case.fluid.kT
        if solutes and not (solutes.ideal(kind) and solutes.wall is None) and not profile.periodic:
            return None  # beads that are not ideal
        if group.molecule is not None:
            return self.expected_of_molecules(profile, decay)
        if decay == 0:
            return np.full(profile.bins, density)
        if case.fluid.mixed:
            return None
        height = profile.edges[-1]
        scale = density * height * decay / np.expm1(decay * height)
        return scale * setting.bin_average(lambda y: np.exp(decay * y), profile.edges)

    def expected_in_traps(self, profile: ProfileAccumulator) -> Array | None:
        """Normal distributions, of which images of the box make one."""
        found = held(self.case, self.kind)
        if found is None or not profile.periodic:
            return None
        given, length = profile.edges, float(profile.edges[-1])
        if self.of == "centres":
            spread = [(found.centre[profile.axis], found.centre_variance)]
        elif found.mean is None or found.variance is None:
            return None
        else:
            which = _ends(self.group) if self.of == "ends" else slice(None)
            spread = list(zip(found.mean[which, profile.axis], found.variance[which], strict=True))
        shares = [theory.normal_in_box(given, float(at), float(s), length) for at, s in spread]
        return self.group.number * np.sum(shares, axis=0) / (self.case.box.volume / profile.bins)

    def expected_of_molecules(self, profile: ProfileAccumulator, decay: float) -> Array | None:
        """Of ideal molecules; None for other bonds, and where the sums would take too long."""
        molecule = self.group.molecule
        assert molecule is not None
        spring, ends = springs_of(self.case, kind_of(self.case, self.group)), _ends(self.group)
        shares = {"centres": 1, "ends": len(ends)}
        number = self.group.number * shares.get(self.of, molecule.length)
        mean = number / float(np.prod(self.case.box.size))
        if profile.periodic:
            return np.full(profile.bins, mean)
        if spring is None:
            return None
        spread = (self.case.fluid.kT / spring.k) ** 0.5
        given = profile.edges, molecule.bonds, spread, decay
        try:
            if self.of == "centres":
                return mean * theory.centre_in_slit(*given)
            beads = theory.beads_in_slit(*given)
        except ValueError:  # a ring's centre, or a grid too fine
            return None
        return mean * (beads[ends] if self.of == "ends" else beads).mean(axis=0)


def _ends(group: Group) -> list[int]:
    """Beads of a molecule that have one bond."""
    if group.molecule is None:
        return [0]
    number = np.bincount(np.ravel(group.molecule.bonds))
    return np.flatnonzero(number == 1).tolist()
