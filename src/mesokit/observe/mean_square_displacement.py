"""Mean square displacement of particles or of molecules, and their diffusion coefficient."""

import math
from typing import ClassVar, Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Axis
from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Either
from mesokit.observe.shared.fitted import fitted_number
from mesokit.observe.shared.of_method import OfMethod
from mesokit.observe.shared.origins import GROUPS, Origins
from mesokit.seam.engine import Particles
from mesokit.seam.estimate import Estimate, fit
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined
from mesokit.statistics import spread_ids

Integers = NDArray[np.int64]
FEWEST = 3  # points of a fit
AGREE = 3.0  # standard errors of the difference of two slopes that agree
DECADE = math.log(10.0)
CHANGES = 2.0  # standard errors of a change of the slope that counts where theory expects one


class Displacement(Protocol):
    """Theory of the displacement of particles by a method.

    It is made of a case and the observable, and raises CaseError where there is nothing to follow.
    `axes` are those that count; `length` particles make a molecule, of which there are `number`.
    What is not overridden holds for particles without a theory.
    """

    axes: tuple[int, ...]
    length: int
    number: int

    def beads(self, wanted: int) -> Integers:
        """Numbers (molecules, length) of so many molecules, evenly spread, or of all."""
        return spread_ids(wanted, self.number)[:, None]

    def expected(self, steps: Integers) -> Array | None:
        """The mean square displacement after so many steps; None without a theory."""
        return None

    def coefficient(self) -> tuple[float, str]:
        """The diffusion coefficient, nan without a theory, and what to say of it."""
        return math.nan, ""

    def with_start(self, error: float, value: float, runs: int) -> float:
        """The error of a number that grows as kT, with what the starts of so many runs add."""
        return error

    def diffusive_from(self) -> float:
        """The lag from which on the displacement is a straight line, inf if never."""
        return 0.0

    def grows(self) -> bool:
        """True if D grows with the lag: in 2D where all momentum is kept."""
        return False

    def level_from(self) -> float:
        """The lag from which on the displacement no longer grows, inf if it always does."""
        return math.inf

    def legend(self) -> str:
        """Name of the theory in a figure."""
        return ""


@component
class MeanSquareDisplacement(OfMethod):
    """Mean square displacement at lags from one sample to `max_lag`, about equally spaced in log.

    Axes along which the fluid flows or that a wall closes are left out unless given. In a fluid of
    molecules whole molecules are followed: all their beads, or their centres of mass.
    """

    quantity: Literal["mean-square-displacement"] = tag("mean-square-displacement")
    methods: ClassVar[tuple[str, ...]] = ()  # those that offer it
    drawing = "displacement"
    units: ClassVar[dict[str, str]] = {"value": "a^2", "time": "tau"}
    in_open_box: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False
    of: Literal["particles", "beads", "centres"] = param(
        "particles", doc='"beads": of solutes or molecules; "centres": their centres of mass'
    )
    kind: int | str | None = param(
        None,
        doc="which kind: name or number of solutes.polymers, or number of fluid.species, from 1; "
        "'fluid': its molecules (the first kind of solutes, particles of all species unless said)",
    )
    particles: int = param(2000, doc="particles (or molecules) followed", ge=1)
    max_lag: int = param(1000, doc="longest lag", unit="steps", ge=1)
    components: Either[None, Axis] = param(
        None, doc="axes that count (all without flow and walls unless said)", min_length=1
    )


def _square_distance(old: Array, new: Array) -> Array:
    difference = new - old
    return np.einsum("ij,ij->i", difference, difference)


# A displacement bends from free flight to diffusion, and the fit must begin beyond. Fits over
# windows that begin ever later, each at twice the lag of the one before, end at the same longest
# lag. The first that agrees with all later ones is taken, and their scatter beyond noise goes into
# its error.


class Slope(NamedTuple):
    """Slope and its standard error, the fitted line (n,), nan outside of its window, and whether
    the curve is straight there; `growth` is by how much the slope changes in a decade of lags, and
    `row` (n,) the combination of the values of the curve that the slope is."""

    value: float
    error: float
    line: Array
    straight: bool
    growth: float
    row: Array

    def error_of_walks(self, time: Array, length: float, walks: int) -> float:
        """The standard error, at least that of so many Brownian walks along an axis.

        Walks that are few times as long as the lags have few parts that are independent, from whose
        scatter no error is known. That of true walks follows from the overlap of displacements
        (Qian, Sheetz and Elson, Biophys. J. 60, 910 (1991), for one lag): the covariance at lags
        a <= b is 8 D^2 a^2 (b - a/3)/(length - b). It is a part r of the true slope, so that a
        slope that is found may be r/(1 - r) of itself too small; infinite where r is 1.

        Parameters
        ----------
        time: (n,) lags of the curve, ascending.
        length: time over which each walk was followed.
        walks: their number times that of axes.

        >>> slope = Slope(2.0, 0.1, np.zeros(3), True, 0.0, np.array([-0.5, 0.0, 0.5]))
        >>> lags = np.array([1.0, 2.0, 3.0])
        >>> round(slope.error_of_walks(lags, 90.0, 12), 3), slope.error_of_walks(lags, 900.0, 12)
        (0.174, 0.1)
        """
        short, long = np.minimum.outer(time, time), np.maximum.outer(time, time)
        covariance = short**2 * (long - short / 3) / np.maximum(length - long, 1e-9 * length)
        part = math.sqrt(2 / walks * float(self.row @ covariance @ self.row))
        return max(self.error, abs(self.value) * part / (1 - part)) if part < 1 else math.inf


def late_slope(time: Array, curve: Estimate, first: float, grows: bool = False) -> Slope | None:
    """Slope of a curve at late lags; None with fewer than three of them.

    Points weigh as 1/t^2, as their errors grow like t.

    Parameters
    ----------
    time: (n,) lags, ascending.
    curve: its value (n,) and how that scatters.
    first: the lag from which on the curve may be a straight line; lag 0 is never used.
    grows: whether theory expects the slope to change for ever, slowly.

    Where it is seen to, or nowhere agrees with the slope at later lags, the growth over a decade of
    lags is part of the error.

    >>> time, noise = np.arange(65.0), np.random.default_rng(1).normal(size=(65, 32)).cumsum(axis=0)
    >>> bent = time + np.expm1(-time)  # free flight at first
    >>> groups = bent[:, None] + 0.01 * noise
    >>> value = groups.mean(axis=1)
    >>> curve = Estimate(value, (groups - value[:, None]).T / 32, np.ones((32, 65)))
    >>> found = late_slope(time, curve, 0.0)
    >>> abs(found.value - 1) < 2 * found.error, found.straight, bool(np.isnan(found.line[1]))
    (True, True, True)
    """
    use = (time >= first) & (time > 0)
    if use.sum() < FEWEST:
        return None
    basis = np.stack([np.ones_like(time), time], axis=1)
    last, starts = time[use][-1], [float(time[use][0])]  # where windows of an octave or more begin
    while 4 * starts[-1] <= last and (use & (time >= 2 * starts[-1])).sum() >= FEWEST:
        starts.append(2 * starts[-1])
    windows = [use & (time >= start) for start in starts]
    slopes = np.stack([_row(time, basis, window) for window in windows])
    value = slopes @ curve.value
    apart = slopes[:, None] - slopes[None]  # differences of any two
    noise = np.stack([curve.linear(row).error for row in apart])
    off = abs(value[:, None] - value[None])
    agree = [bool((off[k, k + 1 :] <= AGREE * noise[k, k + 1 :]).all()) for k in range(len(value))]
    chosen = agree.index(True)  # of the last there is nothing to differ from
    line = fit(curve, basis, _weight(time, windows[chosen])).value
    straight = len(value) == 1 or chosen < len(value) - 1
    errors = curve.linear(slopes).error
    # mean square of what slopes differ by beyond noise, each weighing by its own error
    weight, spread = 1 / errors[chosen:] ** 2, 0.0
    if np.isfinite(weight).all():
        beyond = off[chosen, chosen:] ** 2 - noise[chosen, chosen:] ** 2
        spread = max(0.0, float((weight * beyond).sum() / weight.sum()))
    bend, unsure = _bend(time, curve, use if straight else windows[-2])
    growth = DECADE * bend if not straight or (grows and bend > CHANGES * unsure) else 0.0
    return Slope(
        float(value[chosen]),
        float(np.sqrt(errors[chosen] ** 2 + spread + growth**2)),
        np.where(windows[chosen], basis @ line, np.nan),
        straight,
        growth,
        slopes[chosen],
    )


def _weight(time: Array, window: NDArray[np.bool_]) -> Array:
    """1/t^2 within a window."""
    return np.where(window, 1 / np.maximum(time, time[window][0]) ** 2, 0.0)


def _row(time: Array, basis: Array, window: NDArray[np.bool_], coefficient: int = 1) -> Array:
    """The combination (n,) of the values that a coefficient of a fit is."""
    root = np.sqrt(_weight(time, window))[:, None]
    return np.asarray((np.linalg.pinv(basis * root) * root.T)[coefficient])


def _bend(time: Array, curve: Estimate, use: NDArray[np.bool_]) -> tuple[float, float]:
    """By how much the slope changes while the lag grows by a factor of e, and the standard error of
    that: c of a + b t + c t ln t.

    The scale of time is that of the lags, which leaves c as it is.
    """
    if use.sum() <= FEWEST:
        return 0.0, math.inf
    t = time / time[use].max()
    basis = np.stack([np.ones_like(t), t, t * np.log(np.where(t > 0, t, 1.0))], axis=1)
    row = _row(t, basis, use, 2) / time[use].max()
    return curve.scalar(row @ curve.value, row)


@accumulator_of(MeanSquareDisplacement)
class MeanSquareDisplacementAccumulator(BlockAccumulator):
    """Unwrapped positions at many origins."""

    memory: ClassVar[tuple[str, ...]] = ("origins",)

    def prepare(self) -> None:
        observable, self.timestep = self.observable, method_of(self.case).timestep(self.case)
        self.theory: Displacement = observable.theory(self.case)
        self.axes, self.centres = self.theory.axes, observable.of == "centres"
        max_lag = max(1, observable.max_lag // observable.every)
        length, number = self.theory.length, self.theory.number
        if length == 1:
            self.ids = self.theory.beads(observable.particles).ravel()
            self.walks = len(self.ids)
            self.origins = Origins(self.walks, len(self.axes), max_lag)
            return
        wanted = observable.particles if self.centres else -(-observable.particles // length)
        followed = min(wanted, number)
        followed -= followed % GROUPS if followed > GROUPS else 0
        # bead after bead, so that one molecule is in one group: its beads are not independent
        self.ids = self.theory.beads(followed).T.ravel()
        rows, self.walks = followed if self.centres else len(self.ids), followed
        self.origins = Origins(rows, len(self.axes), max_lag, min(GROUPS, followed))

    def observe(self, engine: Particles) -> None:
        position = engine.positions(self.ids, unwrapped=True)[:, list(self.axes)]
        if self.centres:
            position = position.reshape(self.theory.length, -1, len(self.axes)).mean(axis=0)
        self.origins.add(position, _square_distance)

    def result(self) -> Result:
        """The curve and its slope where it is a straight line."""
        steps, moved = self.origins.sampled() * self.observable.every, self.origins.estimate()
        time, theory = steps * self.timestep, self.theory
        expected, found = theory.expected(steps), list[Comparison]()
        slope = late_slope(time, moved, theory.diffusive_from(), theory.grows())
        if slope is not None:
            found.append(self.diffusion(slope, time))
        elif len(time) > 1 and math.isfinite(first := theory.diffusive_from()):
            why = f"undetermined: fewer than three lags from {first:.3g} to {time[-1]:.3g} tau"
            what, known = "diffusion coefficient", theory.coefficient()[0]
            found.append(Comparison(what, math.nan, math.nan, known, "a^2/tau", why))
        level = time >= theory.level_from()
        if level.any() and expected is not None:
            mean, wanted = level / level.sum(), expected[level].mean()
            what = "mean square displacement, levelled off"
            found.append(Comparison(what, *moved.total(mean), wanted, "a^2"))
        elif np.isfinite(theory.level_from()) and len(steps) > 1:
            begin = math.ceil(theory.level_from() / self.timestep)
            note = (
                f"theory gives the level, from lag {begin} steps on; the longest here is "
                f"{steps[-1]}: a larger max_lag"
            )
            last, what = np.eye(len(steps))[-1], "mean square displacement at the longest lag"
            found.append(Comparison(what, *moved.total(last), math.nan, "a^2", note))
        return self.report(
            {"time": time},
            moved,
            found,
            label="mean square displacement" + " of centres of mass" * self.centres,
            expected=expected,
            fit=None if slope is None else slope.line,
            theory=theory.legend(),
            samples=self.origins.count,
            extra={"components": "".join("xyz"[axis] for axis in self.axes)},
        )

    def diffusion(self, slope: Slope, time: Array) -> Comparison:
        """The diffusion coefficient beside theory, or why it is not known."""
        scale, runs = 1 / (2 * len(self.axes)), self.origins.series
        walks = runs * self.walks * len(self.axes)
        length = self.origins.count / runs * self.observable.every * self.timestep
        value, error = slope.value * scale, slope.error_of_walks(time, length, walks) * scale
        error = self.theory.with_start(error, value, self.origins.series)
        expected, note = self.theory.coefficient()
        if slope.growth:
            short = not (slope.straight or self.theory.grows())
            why = ": no straight line yet, a larger max_lag" if short else ""
            trend = f"approximate: {'grows' if slope.growth > 0 else 'falls'} with the lag{why}"
            decade = "error bar with its change in a decade of lags"
            note = joined(trend, decade, note.removeprefix("approximate: "))
        return fitted_number("diffusion coefficient", value, error, expected, "a^2/tau", note)
