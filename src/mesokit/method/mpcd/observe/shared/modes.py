"""Base of transverse and longitudinal modes: wave vectors, polarisations and correlators."""

from __future__ import annotations

import itertools
from abc import abstractmethod
from collections.abc import Iterable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, param
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Correlation, MultipleTau

Array = NDArray[np.floating[Any]]
SHOWN = 6  # wave numbers in the comparisons, longest waves first


@component
class Modes(Observable):
    """Correlations in time of Fourier modes of the velocity."""

    waves: tuple[tuple[int, ...], ...] = param(
        (), doc="wave vectors, in waves per box length (1 to 3 waves along each axis unless said)"
    )
    max_lag: int | None = param(
        None, doc="longest lag (as the run allows unless said)", unit="steps", ge=1
    )

    def vectors(self, case: Case) -> NDArray[np.int64]:
        """Whole wave vectors (K, d)."""
        d = case.box.dimension
        if self.waves:
            return np.array(self.waves, np.int64)
        closed = setting.closed_axes(case)
        unit = np.eye(d, dtype=np.int64)
        shortest = [(axis, n) for n in (1, 2, 3) for axis in range(d) if axis not in closed]
        return np.array([n * unit[axis] for axis, n in shortest if 2 * n <= case.box.size[axis]])

    def check(self, case: Case) -> None:
        """Raise CaseError for waves that do not fit the box, and under shear."""
        d = case.box.dimension
        if case.box.sheared:
            raise CaseError("not in a sheared box: waves do not fit sliding images")
        for wave in self.waves:
            if len(wave) != d or not any(wave):
                raise CaseError(f"waves = {list(wave)}: expected {d} whole numbers, not all 0")
            for axis in setting.closed_axes(case):
                if wave[axis]:
                    raise CaseError(
                        f"waves = {list(wave)}: expected 0 along {AXES[axis]}, which a wall closes"
                    )


class ModesAccumulator(BlockAccumulator):
    """One correlator for each length of wave vector, of the velocity along `polarise`."""

    memory: ClassVar[tuple[str, ...]] = ("correlators",)

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        vectors = observable.vectors(case)
        self.wavevectors = 2 * np.pi * vectors / np.array(case.box.size, float)
        self.polarisations = np.array([self.polarise(k) for k in self.wavevectors])  # (K, p, d)
        lengths = np.round(np.linalg.norm(self.wavevectors, axis=1), 9)
        max_lag = None if observable.max_lag is None else observable.max_lag // observable.every
        self.wavenumbers = np.unique(lengths)
        self.members = [np.flatnonzero(lengths == length) for length in self.wavenumbers]
        self.correlators = {}
        for i, members in enumerate(self.members):
            shape = (len(members), self.polarisations.shape[1])
            self.correlators[f"shell_{i}"] = MultipleTau(shape, dtype=complex, max_lag=max_lag)

    @property
    def shells(self) -> list[tuple[float, MultipleTau]]:
        """Each wave number and its correlator."""
        return list(zip(self.wavenumbers.tolist(), self.correlators.values(), strict=True))

    @abstractmethod
    def polarise(self, wavevector: Array) -> Array:
        """Unit vectors (p, d)."""

    def observe(self, fluid: RunningFluid) -> None:
        _, momentum = fluid.modes(self.wavevectors)
        amplitude = np.einsum("kpd,kd->kp", self.polarisations, momentum)
        for members, correlator in zip(self.members, self.correlators.values(), strict=True):
            correlator.add(amplitude[members])

    def interval(self) -> float:
        return self.observable.every * self.case.fluid.timestep

    def curves(self) -> tuple[Array, list[Correlation]]:
        """Time (n,), and the normalised correlation of each wave number."""
        every = [
            correlator.correlation(average_over=(0, 1), normalised=True)
            for correlator in self.correlators.values()
        ]
        return every[0].lag * self.interval(), every

    def modes(self, fits: Iterable[Comparison], theory: str) -> Result:
        """The correlations beside a theory of this name, and what is fitted to them."""
        time, every = self.curves()
        first = self.equipartition() if self.undisturbed() else None
        return self.report(
            {"time": time, "wavenumber": self.wavenumbers},
            every,
            itertools.chain(fits, [first]),
            expected=self.law(time),
            theory=theory,
            samples=self.samples,
            extra=self.smooth(time),
        )

    @property
    def samples(self) -> int:
        return self.shells[0][1].count

    def equipartition(self) -> Comparison | None:
        """Mean square of all modes against N m kT."""
        fluid = self.case.fluid
        total = setting.mass_density(self.case) * np.prod(self.case.box.size) * fluid.kT
        values, variances = [], []
        for correlator in self.correlators.values():
            found = correlator.correlation(average_over=(0, 1))
            if not len(found.value):
                return None
            values.append(found.value[0])
            variances.append(found.error[0] ** 2)
        mean, error = np.mean(values) / total, np.sqrt(np.sum(variances)) / len(values) / total
        error = setting.with_start(self.case, error, 1.0, self.shells[0][1].series)
        return Comparison("mean square of the modes", mean, error, 1.0, "N m kT")

    @abstractmethod
    def law(self, time: Array) -> Array | None:
        """The normalised correlation expected, (n, shells); None without a theory."""

    def smooth(self, time: Array) -> dict[str, Array]:
        """The law on a fine grid, for a figure."""
        slowest = self.wavenumbers[0] ** 2  # theory is drawn until 20/k^2, where all is quiet
        fine = np.linspace(0, min(time[-1] if len(time) else 0.0, 20 / slowest), 2000)
        curve = self.law(fine)
        return {} if curve is None else {"curve_time": fine, "curve": curve}

    def undisturbed(self) -> bool:
        """Whether theory of a fluid at rest without walls applies."""
        return not (self.case.walls or setting.driven(self.case))


def transverse_units(wavevector: Array) -> Array:
    """The d - 1 unit vectors (d - 1, d) across a wave vector.

    >>> transverse_units(np.array([2.0, 0.0]))
    array([[-0.,  1.]])
    """
    unit = wavevector / np.linalg.norm(wavevector)
    if len(unit) == 2:
        return np.array([[-unit[1], unit[0]]])
    first = np.cross(unit, np.eye(3)[np.argmin(abs(unit))])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(unit, first)])
