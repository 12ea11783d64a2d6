"""A small bed of grains whose contacts are recorded: disks that fall on a plate and a block."""

from mesokit import Box, Case, Plates, RandomStart, Rectangle, Run, SoftSpheres
from mesokit.case.trajectory import Trajectory
from tests.helpers.soft_spheres import ROUGH

BED = {
    "number": 60, "kT": 0.5, "gravity": [0.0, -2.0], "start": RandomStart(), "pair": ROUGH,
}  # fmt: skip


def grains(steps=10_000, every=2500, warmup=3000, observe=(), trajectory=True, run=None, **kept):
    """The case; `kept` are keys of its trajectory."""
    given = {"fields": ("position", "contact"), "precision": "float64"} | kept
    return Case(
        run=Run(steps, method="soft-spheres", seed=1, warmup=warmup, **(run or {})),
        box=Box([16, 14]),
        walls=[Plates("y"), Rectangle(centre=[8, 2], size=[9, 3], angle=20)],
        spheres=SoftSpheres(**BED),
        observe=list(observe),
        trajectory=Trajectory(every=every, **given) if trajectory else None,
    )
