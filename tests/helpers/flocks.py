"""Flocks for the tests of their laws."""

from mesokit import Box, Case, Disk, Flock, Plates, Run, Surface

SLIP = Surface(rule="slip")
ANY_WALLS = [Plates("y", lower=SLIP, upper=SLIP), Disk(centre=(10, 9), radius=3.3)]


def case(size, steps=100, seed=1, walls=(), observe=(), trajectory=None, **birds):
    return Case(
        run=Run(steps=steps, seed=seed, method="flock"), box=Box(size), flock=Flock(**birds),
        walls=walls, observe=observe, trajectory=trajectory,
    )  # fmt: skip
