"""What each part of a step, each rule and each observation costs."""

from __future__ import annotations

import time
from collections.abc import Iterator
from statistics import median

import mesokit
from benchmarks import once


def rules(rounds: int, seconds: float) -> Iterator[str]:
    """Stages, and collision rules and thermostat relative to plain SRD, on one thread."""
    yield "## Stages and rules"
    yield ""
    yield "Nanoseconds per particle-step on one thread."
    yield ""
    yield "| workload | total | sweep | cells | sort | finish | relative to plain |"
    yield "|---|---|---|---|---|---|---|"
    for base in ("W1", "W4", "W3", "W2"):
        variants = ["thermostat", "at", "srd+a", "at+a"] if base in ("W1", "W4") else []
        names = [base] + [f"{base}-{variant}" for variant in variants]
        found = once.alternate(names, 1, rounds, seconds)
        for name, runs in found.items():
            pairs = zip(runs, found[base], strict=True)
            ratio = median(a["nanoseconds"] / b["nanoseconds"] for a, b in pairs)
            stages = [
                f"{median(one['stages'][stage] for one in runs):.2f}"
                for stage in ("sweep", "cells", "sort", "finish")
            ]
            total = once.middle(runs, "nanoseconds")
            yield f"| {name} | {total:.2f} | {' | '.join(stages)} | {ratio:.2f} |"


def solids(rounds: int, seconds: float) -> Iterator[str]:
    """What solids cost, beside the same fluid in a periodic box."""
    yield "## Solids"
    yield ""
    yield "2D, 400 x 50 cells, thermostat; nanoseconds per particle-step, and relative to no solid."
    yield ""
    yield "| solids | 1 thread | relative | 2 threads | relative | asked |"
    yield "|---|---|---|---|---|---|"
    asked = {"W5-disks": "1.3", "W5-sampled": "1.6"}
    names = {
        "W5": "none, periodic",
        "W5-plates": "two plates",
        "W5-disks": "plates and 6 disks, 10 % of the area",
        "W5-sampled": "the same, the disks as a sampled distance",
    }
    one, two = (once.alternate(list(names), threads, rounds, seconds) for threads in (1, 2))
    for name, words in names.items():
        cells = []
        for runs in (one, two):
            pairs = zip(runs[name], runs["W5"], strict=True)
            ratio = median(a["nanoseconds"] / b["nanoseconds"] for a, b in pairs)
            cells += [f"{once.middle(runs[name], 'nanoseconds'):.2f}", f"{ratio:.2f}"]
        yield f"| {words} | {' | '.join(cells)} | {asked.get(name, '')} |"


def memory(rounds: int, seconds: float) -> Iterator[str]:
    """Bytes per particle: what the arrays take, and how the whole process grows."""
    small, large = once.run("W1@80", 1, 0.0), once.run("W1@112", 1, 0.0)
    grown = 1024 * (large["peak_kilobytes"] - small["peak_kilobytes"])
    slope = grown / (large["particles"] - small["particles"])
    yield "## Memory"
    yield ""
    yield (
        f"3D, 10 particles per cell, one thread. Arrays: {large['bytes_per_particle']:.0f} bytes "
        f"per particle. Peak of the whole process from 80^3 to 112^3 cells: {slope:.0f} bytes per "
        f"particle more, on top of {small['peak_kilobytes'] / 1024:.0f} MB at 80^3."
    )


def observables(rounds: int, seconds: float) -> Iterator[str]:
    """Cost of one sample of each observable, in nanoseconds per particle."""
    yield "## Observation"
    yield ""
    yield "One sample, on one thread, 3D bulk or slit 30^3, density 10."
    yield ""
    yield "| quantity | ns per particle and sample | in steps of plain SRD |"
    yield "|---|---|---|"
    plain = median(_advance_seconds([], rounds) for _ in range(1))
    for observable in _observables():
        took = _sample_seconds(observable, rounds)
        per = 1e9 * took / (10 * 30**3)
        yield f"| {observable.label} | {per:.1f} | {took / plain:.2f} |"


def _observables() -> list[mesokit.Observable]:
    waves = [[1, 0, 0], [0, 1, 0], [1, 1, 0]]
    return [
        mesokit.Conservation(every=1),
        mesokit.VelocityProfile("y", every=1),
        mesokit.DensityProfile("y", every=1),
        mesokit.TemperatureProfile("y", every=1),
        mesokit.VelocityField(every=1),
        mesokit.DensityField(every=1),
        mesokit.MeanSquareDisplacement(every=1),
        mesokit.VelocityAutocorrelation(every=1),
        mesokit.TransverseModes(waves=waves, every=1),
        mesokit.LongitudinalModes(waves=waves, every=1),
        mesokit.Stress(every=1),
        mesokit.WallStress(every=1),
    ]


def _simulation(observe: list[mesokit.Observable]) -> mesokit.Simulation:
    walls = any("walls" in one.measures for one in observe)
    return mesokit.Simulation(
        run=mesokit.Run(steps=10**9),
        box=mesokit.Box([30] * 3),
        fluid=mesokit.Fluid(collision=mesokit.SRD(130)),
        walls=[mesokit.Plates("z")] if walls else [],
        observe=observe,
        threads=1,
    )


def _advance_seconds(observe: list[mesokit.Observable], rounds: int) -> float:
    fluid = _simulation(observe).engine
    fluid.advance(100)
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        fluid.advance(100)
        times.append((time.perf_counter() - start) / 100)
    return median(times)


def _sample_seconds(observable: mesokit.Observable, rounds: int) -> float:
    """Steps taken one at a time with the sample, less the same without it."""
    simulation = _simulation([observable])
    fluid, accumulator = simulation.engine, simulation.accumulators[observable.label]
    stress = "stress" in observable.measures
    times = []
    fluid.advance(50)
    for k in range(10 * rounds):
        start = time.perf_counter()
        fluid.advance(1, ["stress"] if stress else ())
        accumulator.observe(fluid)
        middle = time.perf_counter()
        fluid.advance(10)
        times.append((middle - start) - (time.perf_counter() - middle) / 10)
        del k
    return median(times)
