"""Number of particles, or of molecules, per cell in slices across an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import Group, group_of, kind_of, springs_of
from mesokit.method.mpcd.expected.traps import held, trapped
from mesokit.observe.shared.profile import (
    Array,
    Profile,
    ProfileAccumulator,
    expected_in_slices,
    part_of,
)
from mesokit.observe.shared.whose import groups_of
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case.case import Case

LABELS = {
    "particles": "density",
    "beads": "density of beads",
    "centres": "density of centres of mass",
    "ends": "density of end beads",
}


@component
class DensityProfile(Profile):
    """Particles per cell in slices across an axis.

    Uniform but for a force towards a plate, for plates that keep the beads of molecules off, and
    for traps, in which solutes are spread by Boltzmann's distribution. Rules that make species
    demix leave fewer particles where they meet, of which there is no theory. Of spheres it is the
    density of centres, in gravity between plates beside that of an ideal gas at the temperature as
    measured.
    """

    quantity: Literal["density-profile"] = tag("density-profile")
    of: Literal["particles", "beads", "centres", "ends"] = param(
        "particles",
        doc='"beads": of solutes or molecules; "centres": of mass; "ends": beads with one bond',
    )
    kind: int | str | None = param(
        None,
        doc="which kind: name or number of solutes.polymers or spheres.kinds, or number of "
        "fluid.species, from 1; 'fluid': its molecules (the first kind of solutes, particles of "
        "all species and all spheres unless said)",
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and for what molecules have not."""
        super().check(case)
        if case.particles_have("diameter"):
            groups_of(case, self.of, self.kind)
            return
        molecule = group_of(case, self.of, self.kind).molecule
        if self.of == "ends" and molecule and molecule.topology == "ring":
            raise CaseError("of = 'ends': rings have none")
        if self.of == "centres" and self.axis == "x" and case.box.sheared:
            raise CaseError("of = 'centres': not along 'x' under shear, whose images slide")

    def accumulator(self, case: Case) -> DensityOfSpheres | DensityProfileAccumulator:
        """An empty memory for it."""
        if (known := expected_in_slices(case, self)) is not None:
            return DensityOfSpheres(self, case, known)
        return DensityProfileAccumulator(self, case)


class DensityInSlices(Protocol):
    """What a method of spheres says of their density: a number per volume in slices (slices,)
    between edges, at a mean m v^2 along an axis, None without a theory; what it is called; what to
    say of it; and which slices lie where all centres may be."""

    def expected(self, edges: Array, kT: float) -> Array | None: ...
    def legend(self) -> str: ...
    def note(self, density: Array) -> str: ...
    def inside(self, edges: Array) -> NDArray[np.bool_]: ...


class DensityOfSpheres(ProfileAccumulator):
    """Number and sum of m v^2 of each slice, per volume."""

    def __init__(self, observable: DensityProfile, case: Case, known: DensityInSlices) -> None:
        super().__init__(observable, case, width=2)
        self.known, self.unit, self.dimension = known, case.box.density_unit, case.box.dimension
        self.slice_volume = case.box.volume / self.bins
        if observable.kind is not None:
            (group,) = groups_of(case, observable.of, observable.kind)
            self.ids = group.beads().ravel()

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Both sums."""
        return np.stack([number, energy]) / self.slice_volume

    def result(self) -> Result:
        """The profile, compared as a whole, and beside gravity the mean place."""
        every = of_mean(self.blocks)
        density = Estimate(every.value[0], every.residuals[:, 0], every.weights)
        number, energy = every.value.sum(axis=1)
        kT = float(energy / number) / self.dimension if number > 0 else np.nan
        expected, found = self.known.expected(self.edges, kT), list[Comparison]()
        if expected is not None and self.blocks.count:
            note = self.known.note(expected)
            if np.ptp(expected) > 0:
                share = self.centres / number
                place, error = density.scalar(share @ density.value, share)
                wanted = float(self.centres @ expected / expected.sum())
                what = f"mean {self.observable.axis}, by slices"
                found.append(Comparison(what, place, error, wanted, "a", note))
            if not note:
                inside = self.known.inside(self.edges)
                some = part_of(density, inside)
                found += self.chi_square(some, expected[inside], "against theory")
        return Result(
            quantity="density-profile",
            drawing="profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=density.value,
            error=density.error,
            label="number density",
            units={"value": self.unit, self.observable.axis: "a"},
            expected=expected,
            theory="" if expected is None else self.known.legend(),
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell, "edges": self.edges.copy()},
        )


class DensityProfileAccumulator(ProfileAccumulator):
    """Density of each slice."""

    def __init__(self, observable: DensityProfile, case: Case) -> None:
        super().__init__(observable, case, width=1)
        size = case.box.size
        self.unit = case.box.density_unit
        self.slice_volume = np.prod(size) / self.bins
        self.of = observable.of
        self.kind = 1 if observable.kind is None else observable.kind
        self.group = group_of(case, observable.of, observable.kind)
        self.everything = self.of == "particles" and not (case.fluid.species and observable.kind)

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        if self.everything:
            super().observe(fluid)
            return
        first, last = self.group.first, self.group.first + self.group.number * self.group.length
        number = fluid.sums_of_particles(self.slices, self.bins, [1.0], first, last)
        self.blocks.add(number / self.slice_volume)

    def slices(self, some: Some) -> Terms:
        """Slices of what counts among some molecules, each as one."""
        y = some.positions[:, self.axis]
        if self.of == "centres":
            y = y + some.images[:, self.axis] * self.edges[-1]
            y = y.reshape(-1, self.group.length).mean(axis=1)
            if self.periodic:
                y = y % self.edges[-1]
        elif self.of == "ends":
            y = y.reshape(-1, self.group.length)[:, _ends(self.group)].ravel()
        place = np.searchsorted(self.edges, y, side="right") - 1
        place[y == self.edges[-1]] -= 1  # what lies at the very end is in the last
        place = place[(place >= 0) & (place < self.bins)]
        return place, [np.ones(len(place))]

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Particles per volume."""
        return number[None] / self.slice_volume

    def result(self) -> Result:
        """The profile, compared as a whole and next to each plate."""
        every = of_mean(self.blocks)
        density = Estimate(every.value[0], every.residuals[:, 0], every.weights)
        expected = self.expected()
        found: list[Comparison] = []
        if expected is not None and self.blocks.count:
            found = self.chi_square(density, expected, "against theory")
            if self.trapped:
                found.append(self.spread(density, expected))
            elif not self.periodic:
                cell = self.observable.bins_per_cell
                for name, part in (("lower", slice(0, cell)), ("upper", slice(-cell, None))):
                    mean = np.zeros(self.bins)
                    mean[part] = 1 / cell
                    value, error = density.scalar(mean @ density.value, mean)
                    where = f"density in the cell at the {name} plate"
                    wanted = float(mean @ expected)
                    found.append(Comparison(where, value, error, wanted, self.unit))
        return Result(
            quantity="density-profile",
            drawing="profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=density.value,
            error=density.error,
            label=LABELS[self.of],
            units={"value": self.unit, self.observable.axis: "a"},
            expected=expected,
            theory=self.legend(),
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    @property
    def trapped(self) -> bool:
        """Whether it is of solutes in traps."""
        return self.of != "particles" and trapped(self.case, self.kind)

    def spread(self, density: Estimate, expected: Array) -> Comparison:
        """Mean square distance from the expected middle, by the shorter way round the box."""
        length, share = self.edges[-1], expected / expected.sum()
        turns = np.angle(share @ np.exp(2j * np.pi * self.centres / length))
        away = self.centres - turns * length / (2 * np.pi)
        square = (away - length * np.rint(away / length)) ** 2 / expected.sum()
        value, error = density.scalar(square @ density.value, square)
        what = f"mean square distance from the middle of the traps along {self.observable.axis}"
        return Comparison(what, value, error, float(square @ expected), "a^2")

    def legend(self) -> str:
        """What the theory is called in a figure."""
        if self.trapped:
            return "Boltzmann in traps"
        walls = self.group.molecule is not None and not self.periodic
        return "ideal molecules between walls" if walls else "ideal gas"

    def expected(self) -> Array | None:
        """Uniform where nothing is in the way; else that of a gas or of ideal molecules."""
        case, group = self.case, self.group
        density = group.number * group.length / float(np.prod(case.box.size))
        if setting.obstructed(case) or setting.gathered(case):
            return None
        if self.trapped:
            return self.expected_in_traps()
        weight = 0.0 if self.periodic else float(setting.acceleration(case)[self.axis])
        solutes = None if group.first < case.particles else case.solutes
        kind = solutes.index_of(self.kind) if solutes else 0
        mass = solutes.masses[kind] if solutes else case.fluid.mass
        decay = mass * weight / case.fluid.kT
        if solutes and not (solutes.ideal(kind) and solutes.wall is None) and not self.periodic:
            return None  # beads that are not ideal
        if group.molecule is not None:
            return self.expected_of_molecules(decay)
        if decay == 0:
            return np.full(self.bins, density)
        if case.fluid.mixed:
            return None
        height = self.edges[-1]
        scale = density * height * decay / np.expm1(decay * height)
        return scale * setting.bin_average(lambda y: np.exp(decay * y), self.edges)

    def expected_in_traps(self) -> Array | None:
        """Normal distributions, of which images of the box make one."""
        found = held(self.case, self.kind)
        if found is None or not self.periodic:
            return None
        given, length = self.edges, float(self.edges[-1])
        if self.of == "centres":
            spread = [(found.centre[self.axis], found.centre_variance)]
        elif found.mean is None or found.variance is None:
            return None
        else:
            which = _ends(self.group) if self.of == "ends" else slice(None)
            spread = list(zip(found.mean[which, self.axis], found.variance[which], strict=True))
        shares = [theory.normal_in_box(given, float(at), float(s), length) for at, s in spread]
        return self.group.number * np.sum(shares, axis=0) / self.slice_volume

    def expected_of_molecules(self, decay: float) -> Array | None:
        """Of ideal molecules; None for other bonds, and where the sums would take too long."""
        molecule = self.group.molecule
        assert molecule is not None
        spring, ends = springs_of(self.case, kind_of(self.case, self.group)), _ends(self.group)
        shares = {"centres": 1, "ends": len(ends)}
        number = self.group.number * shares.get(self.of, molecule.length)
        mean = number / float(np.prod(self.case.box.size))
        if self.periodic:
            return np.full(self.bins, mean)
        if spring is None:
            return None
        spread = (self.case.fluid.kT / spring.k) ** 0.5
        given = self.edges, molecule.bonds, spread, decay
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
