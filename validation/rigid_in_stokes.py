"""Creeping flow of a viscous fluid about rigid disks or spheres in a periodic box.

The fluid of bodies is `STIFF` times as viscous. Strain rates on a grid are found by conjugate
gradients in the space of those of incompressible flows, which Fourier transforms project on
(Moulinec and Suquet, Comput. Methods Appl. Mech. Eng. 157, 69 (1998)). All orders of the fraction
and all reflections are in it. The grid makes bodies settle too slowly: a cubic lattice, with 8
points in a radius, by 0.8, 1.5 and 4 % at the fractions 0.008, 0.065 and 0.27 (by Sangani and
Acrivos, 1982). Pages divide by that.
"""

from __future__ import annotations

import math

import numpy as np
from scipy import fft

STIFF, TOLERANCE, MOST_TURNS = 1e3, 1e-4, 400


class Flow:
    """Strain rates of flows among bodies at places (number, d), in units of the fluid's viscosity.

    Arrays have the strain rates xx, xy, ... in their first axis.
    """

    def __init__(self, places: np.ndarray, radius: float, side: float, points: int) -> None:
        d, step = places.shape[1], side / points
        self.shape, self.pairs = (points,) * d, [(a, b) for a in range(d) for b in range(a, d)]
        middles = (np.arange(points) + 0.5) * step
        rigid = np.zeros(self.shape)  # the part of each cell that is in a body
        for place in places:
            square = np.zeros((1,) * d)
            for axis, x in enumerate(place):
                away = (middles - x + side / 2) % side - side / 2
                square = square + (away**2).reshape([-1 if k == axis else 1 for k in range(d)])
            rigid += np.clip(0.5 - (np.sqrt(square) - radius) / step, 0, 1)
        self.rigid = np.minimum(rigid, 1.0)
        self.viscosity = 1 / (1 - self.rigid + self.rigid / STIFF)
        waves = [np.fft.fftfreq(points) * points] * (d - 1) + [np.fft.rfftfreq(points) * points]
        k = np.array(np.meshgrid(*waves, indexing="ij"))
        k[abs(k) == points / 2] = 0.0  # waves without a direction
        size = np.sqrt((k**2).sum(axis=0))
        self.length = np.where(size > 0, side / (2 * math.pi * np.maximum(size, 1.0)), 0.0)  # 1/k
        self.along = k * self.length * 2 * math.pi / side
        self.twice = np.array([1.0 if a == b else 2.0 for a, b in self.pairs]).reshape(
            [-1] + [1] * d
        )

    def transformed(self, values: np.ndarray) -> np.ndarray:
        """Fourier transforms over the box."""
        return np.asarray(fft.rfftn(values, axes=range(1, values.ndim)))

    def back(self, values: np.ndarray) -> np.ndarray:
        """The values that have such transforms."""
        return np.asarray(fft.irfftn(values, s=self.shape, axes=range(1, values.ndim)))

    def across(self, vectors: np.ndarray) -> np.ndarray:
        """Transforms of vectors without their parts along the wave."""
        return vectors - self.along * (vectors * self.along).sum(axis=0)

    def pull(self, strains: np.ndarray) -> np.ndarray:
        """Transforms of twice the strain rates times the direction of the wave, across it."""
        found = np.zeros_like(self.along, dtype=complex)
        for (a, b), values in zip(self.pairs, self.transformed(strains), strict=True):
            found[a] += 2 * values * self.along[b]
            if a != b:
                found[b] += 2 * values * self.along[a]
        return self.across(found)

    def symmetric(self, pull: np.ndarray) -> np.ndarray:
        """Strain rates from `pull`."""
        return self.back(np.array([
            0.5 * (pull[a] * self.along[b] + pull[b] * self.along[a]) for a, b in self.pairs
        ]))  # fmt: skip

    def product(self, a: np.ndarray, b: np.ndarray) -> float:
        """Sum of the products of all elements of two tensors."""
        return float((self.twice * a * b).sum())

    def solve(self, known: np.ndarray) -> np.ndarray:
        """Strain rates of an incompressible flow whose stress has the projection `known`."""
        found, left = np.zeros_like(known), known.copy()
        step, square = left.copy(), self.product(left, left)
        enough = TOLERANCE**2 * square
        for _ in range(MOST_TURNS):
            stress = self.symmetric(self.pull(self.viscosity * step))
            part = square / self.product(step, stress)
            found += part * step
            left -= part * stress
            before, square = square, self.product(left, left)
            if square < enough:
                return found
            step = left + square / before * step
        raise RuntimeError(f"no flow found in {MOST_TURNS} turns")


def viscosity_gain(places: np.ndarray, radius: float, side: float, points: int) -> float:
    """(eta/eta0 - 1)/phi of disks at places, the mean over both directions of shear in 2D."""
    flow, ratios = Flow(places, radius, side, points), []
    for direction in ((1.0, 0.0, -1.0), (0.0, 1.0, 0.0)):  # xx, xy, yy
        mean = np.array(direction)[:, None, None] * np.ones((3, points, points))
        whole = mean + flow.solve(-flow.symmetric(flow.pull(flow.viscosity * mean)))
        ratios.append(flow.product(flow.viscosity * whole, whole) / flow.product(mean, mean))
    return (float(np.mean(ratios)) - 1) * side**2 / (len(places) * math.pi * radius**2)


def settling_speed(places: np.ndarray, radius: float, side: float, points: int) -> float:
    """Mean speed along x of spheres at places, each drawn by the same force, over that of one in a
    wide fluid. All that is in the box takes the counter-force."""
    flow = Flow(places, radius, side, points)
    force = flow.rigid / (flow.rigid.mean() * side**3) * len(places)
    pull = np.zeros_like(flow.along, dtype=complex)
    pull[0] = flow.transformed((force - force.mean())[None])[0]
    strains = flow.solve(flow.symmetric(1j * flow.length * flow.across(pull)))
    speeds = flow.back(-1j * flow.length * flow.pull(strains))[0]
    mean = float((speeds * flow.rigid).sum() / flow.rigid.sum())
    return mean * 6 * math.pi * radius
