"""Velocity in a small part of the fluid in time, and the frequency at which it oscillates."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.digits import two_digits
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.field.protocol import Swing
from mesokit.method.mpcd.observe.shared.shells import nearest, periodic_lengths
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import (
    Blocks,
    TimeSeries,
    dominant_frequency,
    mean_frequency,
    mean_spectrum,
    spectrum,
)

ROWS = 16384  # of the time series
LEAST = 8  # samples in a period: with fewer a cosine is not seen
BEYOND = 3.0  # standard errors below which nothing swings, and no phase is known
DRAWN = 64  # places at which theory is averaged over the small box


@component
class Probe(Observable):
    """Mean velocity of the particles in a small box: its time series and power spectrum.

    The spectrum is of one component, by default that across the flow, in which the vortices of a
    wake show best. Where it has a clear peak the dominant frequency f is given, and with `speed` U
    and `length` D the Strouhal number f D/U. Of a uniform force that oscillates, amplitude and lag
    of the velocity along it are given, from whole periods, and beside theory in a slit.
    """

    quantity: Literal["probe"] = tag("probe")
    drawing = "signal"
    units: ClassVar[dict[str, str]] = {
        "value": "a^2/tau",
        "frequency": "1/tau",
        "velocity": "a/tau",
        "time": "tau",
    }
    centre: Either[None, float] = param(
        None,
        doc="middle of the small box (that of the box unless said); what sticks out of a periodic "
        "axis is at its other end",
        unit="a",
    )
    size: Either[None, float] = param(
        None, doc="its sides (2 cells along each axis unless said)", unit="a"
    )
    component: Axis | None = param(
        None, doc="axis of the velocity whose spectrum is taken (across the flow unless said)"
    )
    speed: float | None = param(None, doc="speed U of the Strouhal number", unit="a/tau", gt=0)
    length: float | None = param(None, doc="length D of the Strouhal number", unit="a", gt=0)

    def check(self, case: Case) -> None:
        """Raise CaseError for a place without fluid, or half a Strouhal number."""
        d = case.box.dimension
        for key in ("centre", "size"):
            vector = getattr(self, key)
            if vector is not None and len(vector) != d:
                raise CaseError(f"{key} = {show(vector)}: expected {d} numbers, one for each axis")
        if self.size is not None and not all(
            0 < side <= length for side, length in zip(self.size, case.box.size, strict=True)
        ):
            raise CaseError(f"size = {show(self.size)}: expected lengths that fit the box")
        place, sides = self.place(case), self.size or (2.0,) * d
        for axis in setting.closed_axes(case):
            half = 0.5 * sides[axis] - 1e-9
            if not half <= place[axis] <= case.box.size[axis] - half:
                raise CaseError(
                    f"centre = {show(place)}: with sides {show(sides)} it reaches over a plate "
                    f"along {AXES[axis]}"
                )
        if self.component is not None:
            case.box.index(self.component, "component")
        if (self.speed is None) != (self.length is None):
            lone, other = ("speed", "length") if self.length is None else ("length", "speed")
            raise CaseError(f"{lone}: no effect without {other}; give both or neither")
        if case.walls and solids_of(case).distance(place)[0] <= 0:
            raise CaseError(f"centre = {show(place)}: lies in a solid")

    def warnings(self, case: Case) -> Iterator[str]:
        yield from setting.across_the_flow(case, self.component)

    def place(self, case: Case) -> tuple[float, ...]:
        """The middle of the small box in this case."""
        return self.centre or tuple(length / 2 for length in case.box.size)

    def seen(self, case: Case) -> int:
        """Number of the axis whose spectrum is taken."""
        if self.component is not None:
            return AXES.index(self.component)
        flowing = setting.driven_axis(case)
        return 1 if flowing in (None, 0) else 0


@accumulator_of(Probe)
class ProbeAccumulator(BlockAccumulator):
    """The time series of the velocity, and its average."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series", "last")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.dimension = d = case.box.dimension
        self.centre = np.array(observable.place(case))
        self.half = np.array(observable.size or (2.0,) * d) / 2
        self.lengths = periodic_lengths(case)
        self.component = observable.seen(case)
        self.blocks, self.series = Blocks((d,)), TimeSeries(d, ROWS)
        self.others: list[TimeSeries] = []  # of runs pooled with it
        self.last = np.zeros(d)  # the last velocity, kept while no particle is near

    def observe(self, fluid: RunningFluid) -> None:
        mass, d = self.case.fluid.mass, self.dimension
        units = [mass, *[math.sqrt(mass * self.case.fluid.kT)] * d]
        m, *momentum = fluid.sums_of_particles(self.inside, 1, units)[:, 0]
        if m > 0:
            self.last = np.array(momentum) / m
        self.blocks.add(self.last)
        self.series.add(fluid.time, self.last)

    def inside(self, some: Some) -> Terms:
        away = nearest(some.positions - self.centre, self.lengths)
        inside = (np.abs(away) <= self.half).all(axis=1)
        m = some.masses[inside]
        return np.zeros(len(m), np.int64), [m, *(m * some.velocities[inside].T)]

    def pool(self, other: ProbeAccumulator) -> None:
        self.blocks.pool(other.blocks)
        self.others.append(other.series)

    def signals(self) -> tuple[list[Array], float]:
        """The series of the component in each run, as long as the shortest, and their interval.

        Runs whose series are thinner than others are left out.
        """
        series = [self.series, *self.others]
        stride = min(one.stride for one in series)
        signals = [one.values()[:, self.component] for one in series if one.stride == stride]
        shortest = min(map(len, signals))
        interval = self.observable.every * self.case.fluid.timestep * stride
        return [signal[:shortest] for signal in signals], interval

    def result(self) -> Result:
        letter = AXES[self.component]
        signals, interval = self.signals()
        found = mean_spectrum([spectrum(signal, interval) for signal in signals])
        peak = mean_frequency([dominant_frequency(signal, interval) for signal in signals])
        return self.report(
            {"frequency": found.frequency},
            (found.power, found.error),
            self.comparisons(peak),
            label=f"power of v_{letter} per frequency",
            extra={
                "time": self.series.time(),
                "velocity": self.series.values(),
                "component": letter,
                "dominant": np.nan if peak is None else peak.value,
            },
        )

    def with_force(self) -> Iterator[Comparison]:
        """Amplitude and lag of the velocity along a force that oscillates."""
        swing = self.case.fluid.force.swing()
        acceleration = swing.of.uniform(self.dimension) if swing else None
        if swing is None or acceleration is None:
            return
        interval = self.observable.every * self.case.fluid.timestep
        low, high = self.centre - self.half, self.centre + self.half
        for k in np.flatnonzero(acceleration):
            series = [
                Series(s.values()[:, k], float(s.time()[0]), interval * s.stride, s.stride)
                for s in (self.series, *self.others)
                if len(s.time())
            ]
            blocks = amplitudes(series, swing.frequency)
            expected = in_slit(self.case, swing, int(k), low, high)
            yield from swings(blocks, swing, AXES[k], expected)

    def comparisons(self, peak: Any) -> Iterator[Comparison]:
        mean: Any = of_mean(self.blocks)
        for k, letter in enumerate(AXES[: self.dimension]):
            speed = mean.value[k], mean.error[k]
            yield Comparison(f"mean velocity v_{letter}", *speed, unit="a/tau")
        yield from self.with_force()
        if peak is None:
            return
        note = f"peak {two_digits(peak.contrast)} times the power around it"
        yield Comparison("dominant frequency", peak.value, peak.error, unit="1/tau", note=note)
        given = self.observable
        if given.speed is not None and given.length is not None:
            scale, note = given.length / given.speed, f"U = {given.speed:g} a/tau"
            yield Comparison("Strouhal number", scale * peak.value, scale * peak.error, note=note)


class Series(NamedTuple):
    """Velocities (n,) of one run, the time of the first, and the interval; each is the mean over
    `stride` samples."""

    values: Array
    begun: float
    interval: float
    stride: int


def amplitudes(series: Sequence[Series], frequency: float) -> Blocks:
    """Of cos(w t) and sin(w t) in each whole period, (2,).

    >>> t = 0.1 * np.arange(640)
    >>> found = amplitudes([Series(3 * np.cos(0.5 * t - 1), 0.0, 0.1, 1)], 0.5)
    >>> found.count, (found.mean() / [np.cos(1), np.sin(1)]).round(6).tolist()
    (5, [3.0, 3.0])
    """
    blocks = Blocks((2,))
    for values, begun, interval, stride in series:
        period = 2 * np.pi / (frequency * interval)  # in samples
        if period < LEAST:
            continue
        half = frequency * interval / 2
        weaker = np.sin(half) / (stride * np.sin(half / stride))  # by the mean over a stride
        edges = np.rint(period * np.arange(len(values) // period + 1)).astype(int)
        for first, last in itertools.pairwise(edges):
            angle = frequency * (begun + interval * np.arange(first, last))
            basis = np.stack([np.cos(angle), np.sin(angle), np.ones_like(angle)], axis=1)
            found, *_ = np.linalg.lstsq(basis, values[first:last], rcond=None)
            blocks.add(found[:2] / weaker)
    return blocks


def swings(
    blocks: Blocks, swing: Swing, along: str, expected: complex | None
) -> Iterator[Comparison]:
    """Amplitude, and lag behind the force, beside the complex amplitude of theory."""
    if not blocks.count:
        return
    mean = of_mean(blocks)
    a, b = mean.value
    size = float(np.hypot(a, b))
    wanted = complex(np.nan, np.nan) if expected is None else expected
    note = "" if expected is None else "no slip at the plates"
    value, error = mean.scalar(size, mean.value / size)
    what = f"amplitude of v_{along} with the force"
    yield Comparison(what, value, error, abs(wanted), "a/tau", note)
    if size > BEYOND * error:
        lag = np.degrees(swing.phase - np.arctan2(-b, a))
        theirs = float(-np.angle(wanted, deg=True))
        lag = (lag - np.nan_to_num(theirs) + 180) % 360 - 180 + np.nan_to_num(theirs)
        value, error = mean.scalar(lag, np.degrees(np.array([-b, a])) / size**2)
        what = f"lag of v_{along} behind the force"
        yield Comparison(what, value, error, theirs, "degrees", note)


def in_slit(case: Case, swing: Swing, component: int, low: Array, high: Array) -> complex | None:
    """Complex amplitude of theory between two places, for a slit that the force would drive
    steadily with no slip; None for other cases."""
    steady = dataclasses.replace(case, fluid=dataclasses.replace(case.fluid, force=swing.of))
    flow, known = setting.flow(steady, component), setting.transport(case)
    if flow.kind != "poiseuille" or known is None or flow.profile is None:
        return None
    height = float(case.box.size[flow.across])
    acceleration = setting.uniform_acceleration(steady)[component]
    places = np.linspace(low[flow.across], high[flow.across], 2 * DRAWN + 1)[1::2]
    chi = theory.oscillating_slit_response(places, height, known.viscosity, swing.frequency)
    return complex(acceleration * chi.mean())
