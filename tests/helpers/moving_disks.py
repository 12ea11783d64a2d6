"""Small cases of bodies that move in a fluid, all of one compiled kind."""

from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.protocol import BodyStart
from mesokit.method.mpcd.body.rectangle import RectangleBody
from mesokit.method.mpcd.fluid import Fluid

LATTICE = BodyStart(rule="lattice")
DISKS = DiskBody(radius=1.5, number=3, name="disks")


def moving_disks(observe=(), steps=40, bodies=(DISKS,), **more) -> Case:
    """Disks in a fluid at rest."""
    return Case(
        run=Run(steps, seed=3),
        box=Box([14, 14]),
        fluid=Fluid(density=5),
        bodies=bodies,
        observe=observe,
        **more,
    )


def with_a_plank(**more) -> Case:
    """Two kinds: disks, and a rectangle."""
    plank = RectangleBody(size=(4, 2), mass=60, name="planks")
    return moving_disks(bodies=(DISKS, plank), **more)
