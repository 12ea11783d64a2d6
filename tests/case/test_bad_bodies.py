"""Wrong bodies: each is refused with one line that names the key, before an engine is made."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mesokit import (
    WCA,
    Box,
    Capsule,
    Case,
    CaseError,
    Demix,
    Disk,
    Fluid,
    Harmonic,
    Molecule,
    NoCollision,
    Plates,
    Polymer,
    Run,
    Sinusoidal,
    Solutes,
    Species,
    Sphere,
    Uniform,
)
from mesokit.method.mpcd.body.capsule import CapsuleBody
from mesokit.method.mpcd.body.cuboid import CuboidBody
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.ellipse import EllipseBody
from mesokit.method.mpcd.body.protocol import (
    BodyStart,
    BodyTrap,
    CounterForce,
    GapPotential,
    Squirming,
)
from mesokit.method.mpcd.body.rectangle import RectangleBody
from mesokit.method.mpcd.body.sphere import SphereBody
from mesokit.method.mpcd.body.spheroid import SpheroidBody
from mesokit.method.mpcd.body.union import UnionBody
from mesokit.method.mpcd.checks.bodies import LONGEST_PATH
from mesokit.method.mpcd.engine.bodies.near import LISTS_HOLD, PARTNERS_HOLD
from mesokit.method.mpcd.start.bodies import first_places
from tests.helpers.refusals import refused

SPACE = "[run]\nsteps = 1\n[box]\nsize = [16, 16, 16]\n"
PLANE = "[run]\nsteps = 1\n[box]\nsize = [16, 16]\n"
BALL = '[[bodies]]\nshape = "sphere"\nradius = 3\n'
DISK = '[[bodies]]\nshape = "disk"\nradius = 3\n'

# what is wrong in a file: the exact line
FILES = {
    SPACE + BALL.replace("[[bodies]]", "[bodies]"):
        "bodies: expected [[bodies]], in double brackets",
    SPACE + BALL.replace("bodies", "body"):
        "body: unknown key of method 'mpcd'; did you mean 'bodies'?",
    SPACE + BALL.replace("radius", "radus"):
        "bodies[#1].radus: unknown key; did you mean 'radius'?",
    SPACE + BALL + 'nam = "a"\n': "bodies[#1].nam: unknown key; did you mean 'name'?",
    SPACE + BALL.replace('shape = "sphere"\n', ""):
        "bodies[#1].shape: missing; expected 'capsule', 'cuboid', 'disk', 'ellipse', 'rectangle', "
        "'sphere', 'spheroid' or 'union'",
    SPACE + BALL.replace("= 3", "= -3"): "bodies[#1].radius = -3: expected a number above 0",
    SPACE + BALL + "number = 0\n": "bodies[#1].number = 0: expected a number of at least 1",
    SPACE + BALL + 'surface = "slippy"\n':
        "bodies[#1].surface = 'slippy': expected 'no-slip' or 'slip'; did you mean 'slip'?",
    SPACE + BALL + 'virtual = "top-up"\n':
        "bodies[#1].virtual = 'top-up': expected 'fill' or 'none'",
    SPACE + BALL + 'fixed = ["w"]\n':
        "bodies[#1].fixed[#1] = 'w': expected 'x', 'y', 'z' or 'orientation'",
    SPACE + BALL + 'fixed = "x"\n': "bodies[#1].fixed = 'x': expected a list",
    SPACE + BALL + 'name = "2"\n':
        "bodies[#1].name = '2': expected a name that is no number: kinds have numbers as well",
    **{
        SPACE + BALL + f'name = "{name}"\n':
        f"bodies[#1].name = '{name}': expected letters, digits, '-', '_', '+' and '.' alone: files "
        "of trajectories have it as one word"
        for name in ("a b", "../a", "\\ta")
    },
    SPACE + BALL + 'name = ""\n':
        "bodies[#1].name = '': expected a longer text, length at least 1",
    SPACE + BALL + 'counter_force = "yes"\n':
        "bodies[#1].counter_force = 'yes': expected true or false",
    SPACE + BALL + "counter_force = 1\n": "bodies[#1].counter_force = 1: expected true or false",
    SPACE + BALL + "mass = 300\ndensity = 3\n":
        "bodies[#1].density = 3: not with mass = 300; give one of them",
    SPACE + BALL + "interaction = false\n": "bodies[#1].interaction = false: expected a table",
    SPACE + BALL + "interaction = { range = 0.1 }\n":
        "bodies[#1].interaction.range = 0.1: expected a number of at least 0.25",
    SPACE + BALL + "interaction = { depth = -1 }\n":
        "bodies[#1].interaction.depth = -1: expected a number of at least 0",
    SPACE + BALL + "trap = {}\n": "bodies[#1].trap.k: missing; a trap needs k, angular or both",
    SPACE + BALL + "trap = { angular = 1, centre = [8, 8, 8] }\n":
        "bodies[#1].trap.centre = [8, 8, 8]: needs k, a stiffness",
    SPACE + BALL + "trap = { k = 1, direction = [1, 0, 0] }\n":
        "bodies[#1].trap.direction = [1, 0, 0]: needs angular, a stiffness",
    SPACE + BALL + "trap = { angular = 1, direction = [0, 0, 0] }\n":
        "bodies[#1].trap.direction = [0, 0, 0]: expected a vector other than 0",
    SPACE + BALL + "hinge = [0, 0, 0]\n":
        "bodies[#1].hinge = [0, 0, 0]: expected a vector other than 0",
    SPACE + BALL + 'hinge = [1, 0, 0]\nfixed = ["orientation"]\n':
        "bodies[#1].hinge: not with fixed = 'orientation', which never turns",
    SPACE + BALL + 'frame = "body"\n':
        "bodies[#1].frame = 'body': needs a force or a torque, whose axes it says",
    SPACE + BALL + "swim = {}\n":
        "bodies[#1].swim.B1 = 0: a squirmer needs B1, B2 or both other than 0",
    SPACE + BALL + 'surface = "slip"\nswim = { B1 = 1 }\n':
        "bodies[#1].swim: not with surface = 'slip', which drags no fluid along",
    SPACE + BALL + 'surface = "slip"\ntorque = [0, 0, 1]\n':
        "bodies[#1].torque = [0, 0, 1]: not on a ball with surface = 'slip', whose spin nothing "
        "slows",
    PLANE + DISK + 'surface = "slip"\ntorque = 2\n':
        "bodies[#1].torque = 2: not on a ball with surface = 'slip', whose spin nothing slows",
    SPACE + BALL + 'surface = "slip"\nvirtual = "fill"\n':
        "bodies[#1].virtual = 'fill': not with surface = 'slip', which has no virtual particles; "
        "expected 'none'",
    SPACE + '[[bodies]]\nshape = "cuboid"\nsize = [4, 4, 4]\nswim = { B1 = 1 }\n':
        "bodies[#1].swim: only of a sphere, disk, spheroid or ellipse",
    SPACE + '[[bodies]]\nshape = "capsule"\nlength = 4\nradius = 2\n':
        "bodies[#1].length = 4: expected more than 2 radius",
    SPACE + BALL + 'start = { rule = "given" }\n':
        "bodies[#1].start.positions: missing; rule = 'given' needs them",
    SPACE + BALL + "start = { positions = [[1, 2, 3]] }\n":
        "bodies[#1].start.positions: only with rule = 'given'",
    **{
        SPACE + BALL + f"start = {{ rule = 'given', positions = {rows} }}\n":
        f"bodies[#1].start.positions = {rows}: expected a list of rows, one for each body, "
        f"{'such as [[5, 5]], ' * (rows == '[5, 5]')}of finite numbers, or a file in quotes"
        for rows in ("5", "[5, 5]", "[[nan, 3, 3]]", "[[true, 3, 3]]", "[['a', 3, 3]]")
    },
    SPACE + BALL + "start = { orientations = [[1, 1, 0, 0]] }\n":
        "bodies[#1].start.orientations[#1] = [1, 1, 0, 0]: expected a unit quaternion, not one of "
        "length 1.414",
    SPACE + '[[bodies]]\nshape = "union"\nparts = [' + ", ".join(
        f'{{ shape = "sphere", centre = [{x}, 0, 0], radius = 2 }}' for x in (0, 3, 0)
    ) + "]\n": "bodies[#1].parts[#3]: the same as parts[#1]; expected another part",
    **{
        SPACE + '[[bodies]]\nshape = "union"\nparts = [{ shape = "sphere", centre = [0, 0, 0], '
        f"radius = 2, {key} = {given} }}]\n":
        f"bodies[#1].parts[#1].{key} = {said}: not of a part; parts have only a shape, and the "
        "body has the rest"
        for key, given, said in (
            ("virtual", '"none"', "'none'"), ("opens", "20", "20"), ("name", '"a"', "'a'"),
        )
    },
    SPACE + '[[bodies]]\nshape = "union"\nparts = [{ shape = "sphere", centre = [0, 0, 0], '
    'radius = 2, fluid = "inside" }]\n': "bodies[#1].parts[#1].fluid = 'inside': expected a solid",
    **{
        SPACE + f'[[bodies]]\nshape = "union"\nparts = [{{ shape = "{name}" }}]\n':
        f"bodies[#1].parts[#1].shape = '{name}': expected 'capsule', 'cuboid', 'disk', 'ellipse', "
        "'rectangle', 'sphere' or 'spheroid'"
        for name in ("cylinder", "half-space")
    },
    **{
        SPACE + f'[[bodies]]\nshape = "sphere"\nradius = 3\n{held}\n'
        "swim = { B1 = 0.1, tumble_rate = 0.2 }\n":
        f"bodies[#1].swim.tumble_rate = 0.2: not with {said}; leave one out"
        for held, said in (
            ("hinge = [0, 0, 1]", "a hinge"),
            ('fixed = ["orientation"]', "fixed = 'orientation'"),
        )
    },
    # what only a start can know
    PLANE + DISK + 'number = 2\nstart = { rule = "given", positions = [[2, 8], [13, 8]] }\n':
        "bodies[#1].start.positions[#2] = [13, 8]: body 2 overlaps body 1, or is nearer than 0.15 "
        "cells to it",
    PLANE + DISK + 'start = { rule = "given", positions = [[8, 2]] }\n'
    '[[wall]]\nshape = "plates"\naxis = "y"\n':
        "bodies[#1].start.positions[#1] = [8, 2]: body 1 is in a wall, about 1 deep",
}  # fmt: skip


def test_a_shape_of_a_wall_is_no_body() -> None:
    with pytest.raises(CaseError, match=r"bodies\[#1\].*expected DiskBody\(\.\.\.\); Disk is of"):
        Case(run=Run(1), box=Box([16, 16]), fluid=Fluid(), bodies=[Disk([8, 8], 2)])
    with pytest.raises(CaseError, match=r"expected Disk\(\.\.\.\); DiskBody is of another section"):
        Case(run=Run(1), box=Box([16, 16]), fluid=Fluid(), walls=[DiskBody(radius=2)])


@pytest.mark.parametrize("text", FILES, ids=[line.partition(":")[0] for line in FILES.values()])
def test_a_file_with_wrong_bodies_is_refused(text: str, tmp_path: Path, capsys) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(text)
    assert refused(capsys, "check", file) == f"mesokit: error: {file}: {FILES[text]}\n"


SPHERE, ROUND = SphereBody(radius=3), DiskBody(radius=3)
FOR_EACH = "numbers, one for each axis of the"
AHEAD = {"radius": 3, "force": [9, 0], "frame": "body"}
LONG = {"size": [6, 4], "force": [9, 0], "frame": "body"}
PUSHED = {"force": [1, 0, 0], "counter_force": True}


def given(*rows: list[float]) -> BodyStart:
    """A start at these places."""
    return BodyStart(rule="given", positions=rows)


# name: (dimension, bodies, other sections, the exact line)
CASES = {
    # shapes
    "a sphere in 2D": (
        2, [SPHERE], {}, "bodies[#1].shape = 'sphere': not in 2D; expected 'capsule', 'disk', "
        "'ellipse', 'rectangle' or 'union'",
    ),
    "a disk in 3D": (
        3, [SPHERE, ROUND], {}, "bodies[#2].shape = 'disk': not in 3D; expected 'capsule', "
        "'cuboid', 'sphere', 'spheroid' or 'union'",
    ),
    "a part of another dimension": (
        2, [UnionBody(parts=[Disk([0, 0], 2), Sphere([3, 0, 0], 2)])], {},
        "bodies[#1].parts[#2].shape = 'sphere': not in 2D; expected 'capsule', 'disk', 'ellipse' "
        "or 'rectangle'",
    ),
    "a part at no place": (
        3, [UnionBody(parts=[Sphere([0, 0], 2)])], {},
        f"bodies[#1].parts[#1].centre = [0, 0]: expected 3 {FOR_EACH} 3D box",
    ),
    "a part between planes": (
        3, [UnionBody(parts=[Capsule([0, 0], [0, 0, 1], 2)])], {},
        f"bodies[#1].parts[#1].start = [0, 0]: expected 3 {FOR_EACH} 3D box",
    ),
    # vectors
    "a short force": (
        3, [SphereBody(radius=3, force=[1, 0])], {},
        f"bodies[#1].force = [1, 0]: expected 3 {FOR_EACH} 3D box",
    ),
    "a long force": (
        2, [DiskBody(radius=3, force=[1, 0, 0])], {},
        f"bodies[#1].force = [1, 0, 0]: expected 2 {FOR_EACH} 2D box",
    ),
    "a short centre": (
        3, [SphereBody(radius=3, trap=BodyTrap(k=1, centre=[8, 8]))], {},
        f"bodies[#1].trap.centre = [8, 8]: expected 3 {FOR_EACH} 3D box",
    ),
    "a centre outside": (
        3, [SphereBody(radius=3, trap=BodyTrap(k=1, centre=[8, 8, 17]))], {},
        "bodies[#1].trap.centre = [8, 8, 17]: outside the box along z; expected 0 to 16",
    ),
    "a long direction": (
        2, [EllipseBody(size=[6, 4], trap=BodyTrap(angular=1, direction=[1, 0, 0]))], {},
        f"bodies[#1].trap.direction = [1, 0, 0]: expected 2 {FOR_EACH} 2D box",
    ),
    "a vector that turns a disk": (
        2, [DiskBody(radius=3, torque=[0, 0, 1])], {},
        "bodies[#1].torque = [0, 0, 1]: expected one number in 2D, about z",
    ),
    "a number that turns a sphere": (
        3, [SphereBody(radius=3, torque=1)], {}, "bodies[#1].torque = 1: expected 3 numbers in 3D",
    ),
    "two that turn a sphere": (
        3, [SphereBody(radius=3, torque=[1, 2])], {},
        "bodies[#1].torque = [1, 2]: expected 3 numbers in 3D",
    ),
    "fixed along z": (
        2, [DiskBody(radius=3, fixed=["x", "z"])], {},
        "bodies[#1].fixed = ['x', 'z']: a 2D box has only 'x' and 'y'",
    ),
    "a velocity along what is fixed": (
        2, [DiskBody(radius=3, fixed=["y"], start=BodyStart(
            rule="given", positions=[[9, 9]], velocities=[[0.1, 0.2]]))], {},
        "bodies[#1].start.velocities[#1] = [0.1, 0.2]: expected 0 along y, as fixed",
    ),
    "a spin across the hinge": (
        3, [SphereBody(radius=3, hinge=[0, 1, 1], start=BodyStart(
            rule="given", positions=[[9, 9, 9]], spins=[[0.3, 0, 0.5]]))], {},
        "bodies[#1].start.spins[#1] = [0.3, 0, 0.5]: expected a multiple of hinge = [0, 1, 1]",
    ),
    "a place fixed along a shear flow alone": (
        2, [DiskBody(radius=3, fixed=["x"])], {"box": Box([20, 20], shear_rate=0.1)},
        "bodies[#1].fixed = ['x']: under box.shear_rate 'x' needs 'y', as images above and below "
        "slide along x",
    ),
    "a hinge in 2D": (
        2, [DiskBody(radius=3, hinge=[0, 0, 1])], {},
        "bodies[#1].hinge = [0, 0, 1]: only in 3D; in 2D all bodies turn about z alone",
    ),
    "a trap about the hinge": (
        3, [SphereBody(radius=3, hinge=[0, 0, 2], trap=BodyTrap(angular=5, direction=[0, 0, -1]))],
        {}, "bodies[#1].trap.angular = 5: its direction [0, 0, -1] is along hinge = [0, 0, 2], "
        "about which it turns nothing; expected one across it",
    ),
    "a short hinge": (
        3, [SphereBody(radius=3, hinge=[0, 1])], {},
        f"bodies[#1].hinge = [0, 1]: expected 3 {FOR_EACH} 3D box",
    ),
    # sizes
    "a large sphere": (
        3, [SphereBody(radius=6.5)], {}, "bodies[#1].radius = 6.5: its images may meet, for it is "
        "13 long; expected a length of at most 12 in a box of 16 along x",
    ),
    "a long rod": (
        2, [CapsuleBody(length=14, radius=1)], {}, "bodies[#1].length = 14: its images may meet, "
        "for it is 14 long; expected a length of at most 12 in a box of 16 along x",
    ),
    "a long spheroid": (
        3, [SpheroidBody(half_length=7, radius=2)], {}, "bodies[#1].half_length = 7: its images "
        "may meet, for it is 14 long; expected a length of at most 12 in a box of 16 along x",
    ),
    "a wide spheroid": (
        3, [SpheroidBody(half_length=2, radius=7)], {}, "bodies[#1].radius = 7: its images may "
        "meet, for it is 14 long; expected a length of at most 12 in a box of 16 along x",
    ),
    "a large rectangle between plates": (
        2, [RectangleBody(size=[12, 5])], {"walls": [Plates("x")]}, "bodies[#1].size = [12, 5]: "
        "its images may meet, for it is 13 long; expected a length of at most 12 in a box of 16 "
        "along y",
    ),
    "a large union": (
        2, [UnionBody(parts=[Disk([0, 0], 2), Disk([10, 0], 2)])], {}, "bodies[#1].parts: its "
        "images may meet, for it is 14 long; expected a length of at most 12 in a box of 16 along "
        "x",
    ),
    "a part far away": (
        2, [UnionBody(parts=[Disk([0, 0], 2), Disk([1e300, 0], 2)])], {}, "bodies[#1].parts[#2]."
        "centre = [1e+300, 0]: expected numbers of at most 1e+06",
    ),
    "a sphere without a volume": (
        3, [SphereBody(radius=1e300)], {}, "bodies[#1].radius = 1e+300: it is 2e+300 long; "
        "expected a length from 0.002 to 2e+06",
    ),
    "a union without a volume": (
        2, [UnionBody(parts=[Disk([0, 0], 1e300)])], {}, "bodies[#1].parts: it is 2e+300 long; "
        "expected a length from 0.002 to 2e+06",
    ),
    "a small sphere": (
        3, [SPHERE, SphereBody(radius=0.5)], {}, "bodies[#2].radius = 0.5: it is 1 cells "
        "thick, with a mass of 5.24; expected at least 10, that of 10 particles of the fluid, and "
        "2 cells: a finer resolution, with all lengths in more cells",
    ),
    "a thin rod": (
        2, [CapsuleBody(length=5, radius=0.05, density=1)], {}, "bodies[#1].radius = 0.05: it is "
        "0.1 cells thick, with a mass of 0.498; expected at least 10, that of 10 particles of the "
        "fluid, and 2 cells: a finer resolution, with all lengths in more cells",
    ),
    "a flat spheroid": (
        3, [SpheroidBody(half_length=0.01, radius=4)], {}, "bodies[#1].half_length = 0.01: it is "
        "0.02 cells thick, with a mass of 6.7; expected at least 10, that of 10 particles of the "
        "fluid, and 2 cells: a finer resolution, with all lengths in more cells",
    ),
    "a light sphere": (
        3, [SphereBody(radius=3, mass=15)], {"fluid": Fluid(mass=2)}, "bodies[#1].mass = 15: a "
        "mass of 15; expected at least 20, that of 10 particles of the fluid",
    ),
    "a thin cuboid": (
        3, [CuboidBody(size=[4, 4, 4], density=0.1)], {}, "bodies[#1].density = 0.1: a mass of "
        "6.4; expected at least 10, that of 10 particles of the fluid",
    ),
    "too many": (
        3, [SphereBody(radius=1, number=2**24), SphereBody(radius=1)], {},
        "bodies: 16777217 in all; expected at most 16777216",
    ),
    "no fluid left": (
        2, [DiskBody(radius=3, number=9)], {},
        "bodies[#1].number = 9: bodies fill 254.5 of 256 cells; expected at most 90%: fewer or "
        "smaller bodies",
    ),
    "one body too many": (
        2, [RectangleBody(size=[8, 8]) for _ in range(4)], {},
        "bodies: they fill 256 of 256 cells; expected at most 90%: fewer or smaller bodies",
    ),
    "one name": (
        3, [SphereBody(radius=3, name="ball"), SphereBody(radius=2, name="ball")], {},
        "bodies[#2].name: 'ball' is also the name of bodies[#1]; rename one",
    ),
    "the name of another": (
        3, [SPHERE, SphereBody(radius=2, name="sphere-1")], {},
        "bodies[#2].name: 'sphere-1' is also the name of bodies[#1]; rename one",
    ),
    **{
        f"the name {name} of other particles": (
            3, [SphereBody(radius=3, name=name)], {},
            f"bodies[#1].name = '{name}': reserved for particles; expected another name",
        )
        for name in ("fluid", "fluid-2", "solutes", "all", "bodies")
    },
    # what moves them
    "a sphere that tumbles too often": (
        3, [SphereBody(radius=3, swim=Squirming(B1=0.1, tumble_rate=1e9))], {},
        "bodies[#1].swim.tumble_rate = 1000000000: 1e+08 turns in a timestep; expected at most 1, "
        "or 10",
    ),
    "a spheroid that tumbles": (
        3, [SpheroidBody(half_length=4, radius=3, swim=Squirming(B1=1, tumble_rate=0.1))], {},
        "bodies[#1].swim.tumble_rate = 0.1: only of a sphere or a disk; others have no room to "
        "turn at once",
    ),
    "light bodies in a long timestep": (
        2, [DiskBody(radius=1, mass=20)], {"fluid": Fluid(timestep=0.5, density=10)},
        "bodies[#1].mass = 20: at 4 thermal velocities it moves by 0.447 cells in a timestep; "
        "expected at most 0.35: a shorter fluid.timestep, or heavier",
    ),
    "nothing to balance": (
        3, [SphereBody(radius=3, counter_force=True)], {},
        "bodies[#1].counter_force = true: needs a force that it balances",
    ),
    "a force that turns": (
        3, [SphereBody(radius=3, frame="body", **PUSHED)], {}, "bodies[#1].counter_force = true: "
        "not with frame = 'body', whose force turns with the body; use 'box'",
    ),
    "a force that plates take": (
        3, [SphereBody(radius=3, **PUSHED)], {"walls": [Plates("y")]}, "bodies[#1].counter_force "
        "= true: not with walls, which take the force; leave it out",
    ),
    "a force in a wave": (
        3, [SphereBody(radius=3, **PUSHED)], {"fluid": Fluid(force=Sinusoidal(amplitude=0.1))},
        "bodies[#1].counter_force = true: not with fluid.force.rule = 'sinusoidal'; expected "
        "'uniform' or 'none'",
    ),
    # what takes the opposite of a force
    "a counter-force inside of a disk": (
        2, [DiskBody(**AHEAD, counter=CounterForce(at=[-2, 0]))], {},
        "bodies[#1].counter.at = [-2, 0]: inside of the body; expected 3 or more from its centre",
    ),
    "a counter-force inside of a rectangle": (
        2, [RectangleBody(**LONG, counter=CounterForce(at=[-2.9, 1.9]))], {},
        "bodies[#1].counter.at = [-2.9, 1.9]: inside of the body; expected a place outside",
    ),
    "a counter-force in 3D of a disk": (
        2, [DiskBody(**AHEAD, counter=CounterForce(at=[-4, 0, 0]))], {},
        f"bodies[#1].counter.at = [-4, 0, 0]: expected 2 {FOR_EACH} 2D box",
    ),
    "a counter-force on few particles": (
        2, [DiskBody(**AHEAD, counter=CounterForce(at=[-4, 0], radius=0.5))],
        {"fluid": Fluid(density=5)},
        "bodies[#1].counter.radius = 0.5: about 3.9 particles; expected 5 or more to take the "
        "force",
    ),
    "a counter-force at an image": (
        2, [DiskBody(**AHEAD, counter=CounterForce(at=[-7, 0]))], {},
        "bodies[#1].counter.at = [-7, 0]: it reaches 8 from the centre; expected at most 6 in a "
        "box of 16 along x",
    ),
    # starts
    "too few places": (
        3, [SphereBody(radius=3, number=2, start=given([1, 2, 3]))], {},
        "bodies[#1].start.positions: 1 row; expected 2, one for each body (number)",
    ),
    "a flat place": (
        3, [SphereBody(radius=3, start=given([1, 2]))], {},
        "bodies[#1].start.positions[#1] = [1, 2]: expected 3 numbers",
    ),
    "a place outside": (
        3, [SphereBody(radius=3, start=given([1, 2, -3]))], {},
        "bodies[#1].start.positions[#1] = [1, 2, -3]: outside the box along z; expected 0 to 16",
    ),
    "an angle in 3D": (
        3, [SphereBody(radius=3, start=BodyStart(orientations=[[90]]))], {},
        "bodies[#1].start.orientations[#1] = [90]: expected 4 numbers, a quaternion",
    ),
    "a quaternion in 2D": (
        2, [DiskBody(radius=3, start=BodyStart(orientations=[[1, 0, 0, 0]]))], {},
        "bodies[#1].start.orientations[#1] = [1, 0, 0, 0]: expected 1 number, its angle",
    ),
    "too many velocities": (
        2, [DiskBody(radius=3, start=BodyStart(velocities=[[0, 0], [0, 0]]))], {},
        "bodies[#1].start.velocities: 2 rows; expected 1, one for each body (number)",
    ),
    # what moves too fast
    "a fast start": (
        2, [DiskBody(radius=3, start=BodyStart(velocities=[[100, 0]]))], {},
        "bodies[#1].start.velocities[#1] = [100, 0]: it moves by 10 cells in a timestep; expected "
        "at most 0.35: a shorter fluid.timestep, or slower",
    ),
    "a fast turn": (
        2, [EllipseBody(size=[6, 4], start=BodyStart(spins=[[2]]))], {},
        "bodies[#1].start.spins[#1] = [2]: it moves by 0.6 cells in a timestep; expected at most "
        "0.35: a shorter fluid.timestep, or slower",
    ),
    "a fast turn of a disk without gaps": (
        2, [DiskBody(radius=3, start=BodyStart(spins=[[2]]), interaction=GapPotential(depth=0))],
        {}, "bodies[#1].start.spins[#1] = [2]: it moves by 0.6 cells in a timestep; expected at "
        "most 0.35: a shorter fluid.timestep, or slower",
    ),
    "a strong force": (
        2, [DiskBody(radius=3, mass=200, force=[1e6, 0])], {},
        "bodies[#1].force = [1000000, 0]: in the first timestep the surface gets to 50 cells in a "
        "timestep; expected at most 0.35: a shorter fluid.timestep, or weaker",
    ),
    "a strong torque": (
        2, [DiskBody(radius=3, mass=200, torque=1e6)], {},
        "bodies[#1].torque = 1000000: in the first timestep the surface gets to 33.3 cells in a "
        "timestep; expected at most 0.35: a shorter fluid.timestep, or weaker",
    ),
    "a fast swimmer": (
        2, [DiskBody(radius=3, swim=Squirming(B1=-50))], {},
        "bodies[#1].swim.B1 = -50: it swims by 2.5 cells in a timestep; expected at most 0.35: a "
        "shorter fluid.timestep, or smaller",
    ),
    "a trap of a fixed place": (
        2, [DiskBody(radius=3, fixed=("x", "y"), trap=BodyTrap(k=1, angular=1))], {},
        "bodies[#1].trap.k = 1: not with fixed = ['x', 'y'], which holds it still",
    ),
    "a trap of a fixed orientation": (
        2, [EllipseBody(size=[6, 4], fixed=("orientation",), trap=BodyTrap(angular=2))], {},
        "bodies[#1].trap.angular = 2: not with fixed = ['orientation'], which holds it still",
    ),
    "a stiff trap": (
        2, [DiskBody(radius=3, mass=200, trap=BodyTrap(k=1e9))], {},
        "bodies[#1].trap.k = 1000000000: too stiff, it swings by 224 rad in a timestep; expected "
        "at most 3.14, or k = 1.97e+05",
    ),
    "a stiff trap of the angle": (
        2, [EllipseBody(size=[6, 4], mass=200, trap=BodyTrap(angular=1e9))], {},
        "bodies[#1].trap.angular = 1000000000: too stiff, it swings by 124 rad in a timestep; "
        "expected at most 3.14, or angular = 6.42e+05",
    ),
    # what is not there yet
    "an open box": (
        3, [SPHERE], {"box": Box([16] * 3, open=["x"]), "fluid": Fluid(collision=NoCollision())},
        "box.open = ['x']: not with bodies; leave one of both out",
    ),
    "molecules": (
        3, [SPHERE], {"fluid": Fluid(molecule=Molecule(bond=Harmonic(K=1)))},
        "fluid.molecule: not with bodies yet; expected a fluid of single particles",
    ),
    "a mixture": (
        3, [SPHERE], {"fluid": Fluid(species=[Species(1, 5), Species(2, 5)])},
        "fluid.species: of different mass, not with bodies yet; expected one mass",
    ),
    "fluids that demix": (
        3, [SPHERE], {"fluid": Fluid(species=[Species(1, 5), Species(1, 5)], collision=Demix())},
        "fluid.collision.rule = 'demix': not with bodies yet; use 'srd'",
    ),
    "beads that push the fluid away": (
        3, [SPHERE], {"solutes": Solutes([Polymer(3)], coupling="potential", solvent_pair=WCA())},
        "solutes.coupling = 'potential': not with bodies yet; expected 'collision'",
    ),
    "beads in a random solvent": (
        3, [SPHERE], {"solutes": Solutes([Polymer(3)], solvent="random")},
        "solutes.solvent = 'random': not with bodies, which a fluid moves; expected 'fluid'",
    ),
    "a gap that is too stiff for beads": (
        3, [SphereBody(radius=3, interaction=GapPotential(depth=1e6))],
        {"solutes": Solutes([Polymer(3)], mass=0.01)},
        "bodies: the stiffest gap of a bead needs 224494 sub-steps in a timestep; expected at most "
        "100000: less interaction.depth, heavier beads (solutes.mass), or a shorter fluid.timestep",
    ),
    "a body that beads enter": (
        3, [SphereBody(radius=3, interaction=GapPotential(depth=0))],
        {"solutes": Solutes([Polymer(3)])},
        "bodies[#1].interaction.depth = 0: not with solutes, whose beads would enter the body; "
        "expected more than 0",
    ),
}  # fmt: skip


def case_of(d: int, bodies, **parts) -> Case:
    """A case with these bodies in a small box."""
    box = parts.pop("box", Box([16] * d))
    return Case(run=Run(steps=1), box=box, bodies=bodies, **parts)


@pytest.mark.parametrize("name", CASES)
def test_a_case_with_wrong_bodies_is_refused(name: str) -> None:
    d, bodies, parts, expected = CASES[name]
    with pytest.raises(CaseError) as error:
        case_of(d, bodies, **parts)
    assert str(error.value) == expected


def test_the_longest_path_is_that_of_the_engine() -> None:
    assert pytest.approx(LONGEST_PATH) == PARTNERS_HOLD - LISTS_HOLD


WIDE = {"box": Box([30, 30])}
ROD, OVAL, SQUARE = {"length": 10, "radius": 1}, {"size": [10, 4]}, {"size": [4, 4]}
PAIR = {"number": 2}
ON_EDGE = BodyStart(rule="given", positions=[[10, 3.9]], orientations=[[90]])
SLIT, POST = {"walls": [Plates("y")]}, {"walls": [Disk([10, 10.2], 0.7)]}
# name: (bodies in a box of 30 x 30, walls, the exact line; "" where there is room)
STARTS = {
    "rods side by side": ([CapsuleBody(**ROD, **PAIR, start=given([10, 9], [10, 11.1]))], {}, ""),
    "rods": (
        [CapsuleBody(**ROD, **PAIR, start=given([10, 9], [10, 10.9]))], {},
        "bodies[#1].start.positions[#2] = [10, 10.9]: body 2 overlaps body 1",
    ),
    "rods across an end": (
        [CapsuleBody(**ROD, **PAIR, start=given([6, 9], [26.1, 9]))], {},
        "bodies[#1].start.positions[#2] = [26.1, 9]: body 2 overlaps body 1",
    ),
    "beside an end": ([CapsuleBody(**ROD, **PAIR, start=given([6, 9], [25.9, 9]))], {}, ""),
    "one in another": (
        [EllipseBody(**OVAL, start=given([9, 9])), DiskBody(radius=1, start=given([10, 9]))], {},
        "bodies[#2].start.positions[#1] = [10, 9]: body 1 overlaps body 1 of bodies[#1]",
    ),
    "corners": ([RectangleBody(**SQUARE, **PAIR, start=given([9, 9], [13.1, 13.1]))], {}, ""),
    "corners that overlap": (
        [RectangleBody(**SQUARE, **PAIR, start=given([9, 9], [12.9, 12.9]))], {},
        "bodies[#1].start.positions[#2] = [12.9, 12.9]: body 2 overlaps body 1",
    ),
    "disks on one lattice": (
        [DiskBody(radius=3, start=BodyStart(rule="lattice")) for _ in range(2)], {},
        "bodies[#2].start: its body 1 overlaps body 1 of bodies[#1], or is nearer than 0.15 cells "
        "to it; expected fewer or smaller bodies",
    ),
    "a lattice that touches": (
        [DiskBody(radius=1.5, number=100, start=BodyStart(rule="lattice"))], {},
        "bodies[#1].start: its body 2 overlaps body 1, or is nearer than 0.15 cells to it; "
        "expected fewer or smaller bodies",
    ),
    "flat on a plate": ([EllipseBody(**OVAL, start=given([10, 2.1]))], SLIT, ""),
    "in a plate": (
        [EllipseBody(**OVAL, start=given([10, 1.8]))], SLIT,
        "bodies[#1].start.positions[#1] = [10, 1.8]: body 1 is in a wall, about 0.2 deep",
    ),
    "on edge in a plate": (
        [EllipseBody(**OVAL, start=ON_EDGE)], SLIT,
        "bodies[#1].start.positions[#1] = [10, 3.9]: body 1 is in a wall, about 1.1 deep",
    ),
    "around a post": (
        [EllipseBody(**OVAL, start=given([10, 10]))], POST,
        "bodies[#1].start.positions[#1] = [10, 10]: body 1 is in a wall, about 0.69 deep",
    ),
    "far from a post": ([DiskBody(radius=8, start=given([10, 19]))], POST, ""),
}  # fmt: skip


@pytest.mark.parametrize("name", STARTS)
def test_bodies_of_all_shapes_start_apart(name: str) -> None:
    bodies, walls, expected = STARTS[name]
    case = case_of(2, bodies, **WIDE, **walls)
    if not expected:
        first_places(case)
        return
    with pytest.raises(CaseError) as error:
        first_places(case)
    assert str(error.value) == expected


def test_ten_thousand_spheres_start_apart() -> None:
    case = case_of(3, [SphereBody(radius=3, number=10_000)], box=Box([256] * 3))
    places, turns = first_places(case)
    away = places[::10, None] - places[None, ::10]
    away -= 256 * np.rint(away / 256)
    distance = np.sqrt((away**2).sum(axis=2))[~np.eye(1000, dtype=bool)]
    assert distance.min() > 6.0
    assert np.linalg.norm(turns, axis=1) == pytest.approx(1.0)


def test_where_no_place_is_found_it_is_said_how_many_found_one() -> None:
    case = case_of(2, [DiskBody(radius=3, number=7)])
    with pytest.raises(CaseError, match=r"bodies\[#1\].number = 7: no room was found for more"):
        first_places(case)


def test_no_repulsion_can_be_said_in_a_file(tmp_path: Path) -> None:
    bare = case_of(3, [SphereBody(radius=3, interaction=GapPotential(depth=0))])
    file = tmp_path / "bare.toml"
    file.write_text(bare.to_toml())
    assert Case.from_toml(file) == bare
    assert bare.bodies[0].interaction.depth == 0
    assert case_of(3, [SPHERE]).bodies[0].interaction.depth == 1


def test_a_uniform_force_goes_with_a_counter_force() -> None:
    case_of(3, [SphereBody(radius=3, **PUSHED)], fluid=Fluid(force=Uniform([0.1, 0, 0])))
