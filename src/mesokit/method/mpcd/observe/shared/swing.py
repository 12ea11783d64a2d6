"""How a velocity swings with a force that oscillates: amplitude and lag, from whole periods."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mesokit import theory
from mesokit.method.mpcd.expected import setting
from mesokit.seam.estimate import Array, of_mean
from mesokit.seam.result import Comparison
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.mpcd.field.protocol import Swing

LEAST = 8  # samples in a period: with fewer a cosine is not seen
BEYOND = 3.0  # standard errors below which nothing swings, and no phase is known
DRAWN = 64  # places at which theory is averaged over the small box


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


def comparisons(
    blocks: Blocks, swing: Swing, along: str, expected: complex | None
) -> Iterator[Comparison]:
    """Amplitude, and lag behind the force, beside the complex amplitude that theory knows."""
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
        yield Comparison(
            f"lag of v_{along} behind the force", value, error, theirs, "degrees", note
        )


def in_slit(case: Case, swing: Swing, component: int, low: Array, high: Array) -> complex | None:
    """Complex amplitude of theory between two places, for a slit that the force would drive
    steadily with no slip; None for other cases."""
    steady = dataclasses.replace(case, fluid=dataclasses.replace(case.fluid, force=swing.of))
    flow, known = setting.flow(steady, component), setting.transport(case)
    if flow.kind != "poiseuille" or known is None or flow.profile is None:
        return None
    height, push = float(case.box.size[flow.across]), setting.acceleration(steady)[component]
    places = np.linspace(low[flow.across], high[flow.across], 2 * DRAWN + 1)[1::2]
    chi = theory.oscillating_slit_response(places, height, known.viscosity, swing.frequency)
    return complex(push * chi.mean())
