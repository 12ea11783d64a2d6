"""Wrong cases of rigid grains: each is refused with one line that names the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit.cli import main
from tests.helpers.refusals import changed, has_words, refused

GOOD = """
[run]
steps = 10
method = "contact-dynamics"
[box]
size = [20, 10.5]
[spheres]
number = 30
timestep = 0.002
kinds = [{ diameter = 1 }]
contact = { friction = 0.5, restitution = 0.3 }
solver = { rule = "gauss-seidel", sweeps = 50 }
gravity = [0, -1]
[[wall]]
shape = "plates"
axis = "y"
lower = { contact = { restitution = 0.8 } }
[[observe]]
quantity = "wall-force"
every = 2
"""
WALL = GOOD[GOOD.index("[[wall]]") : GOOD.index("[[observe]]")]
OBSERVED = GOOD[GOOD.index("[[observe]]") :]
STEP, LAW, OWN = "timestep = 0.002", "friction = 0.5, restitution = 0.3", "{ restitution = 0.8 }"
RULE = 'rule = "gauss-seidel", sweeps = 50'
PULL = "cohesion = { force = 1, range = 0.01 }"
# a box of whole lengths, without walls and gravity
FREE = {WALL: "", OBSERVED: "", "gravity = [0, -1]": "", "[20, 10.5]": "[20, 10]"}
SHEAR = {**FREE, "[20, 10.5]": "[20, 10]\nshear_rate = 0.1"}
DISK = '[[wall]]\nshape = "disk"\nradius = 2\ncentre = [5, 5]\n'
# name: (what is replaced by what in the good case, what the message must say)
BAD: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    "misspelt method": ({'"contact-dynamics"': '"contact-dynamic"'},
                        ("run.method", "'contact-dynamics'")),
    "misspelt key": ({"number = 30": "nunber = 30"}, ("spheres.nunber", "'number'")),
    "key of soft spheres": ({STEP: "speed = 1"},
                            ("spheres.speed: unknown key of method 'contact-dynamics'",
                             "one of 'soft-spheres'", "has contact, solver, push_back of its own")),
    "key of event-driven": ({STEP: 'collision = { rule = "hard" }'},
                            ("spheres.collision: unknown key",)),
    "solver without table": ({"solver = { " + RULE + " }": 'solver = "gauss-seidl"'},
                             ("spheres.solver = 'gauss-seidl'", "{ rule = 'gauss-seidel' }")),
    "no time": ({STEP: "timestep = 0"}, ("spheres.timestep = 0", "above 0")),
    "coarse": ({STEP: "kT = 1\ntimestep = 0.2"},
               ("spheres.timestep = 0.2: grains pass the skin", "(0.25)", "less than 0.0")),
    "coarse by gravity": ({STEP: "timestep = 0.5"},
                          ("spheres.timestep = 0.5: grains pass the skin", "less than 0.2")),
    "coarse by bounces": ({STEP: "timestep = 0.25", OWN: "{ restitution = 1 }"},
                          ("spheres.timestep = 0.25: grains pass", "less than 0.2")),
    "coarse by a wall": ({STEP: "timestep = 0.1", "lower = {": "lower = { velocity = [2, 0],"},
                         ("spheres.timestep = 0.1: grains pass", "less than 0.0")),
    "coarse by skin": ({STEP: "timestep = 0.1\nskin = 0.001"},
                       ("spheres.timestep = 0.1: grains pass", "(0.001)")),
    "coarse vibration": ({STEP: "timestep = 0.05", OWN: "{ amplitude = 0.01, frequency = 50 }"},
                         ("wall[#1].lower.contact.frequency = 50", "at least 6", "0.0209")),
    "no skin": ({STEP: "skin = 0"}, ("spheres.skin = 0", "above 0")),
    "thick skin": ({STEP: "skin = 10"}, ("spheres.skin = 10", "less than 9", "along x")),
    "push back": ({STEP: "push_back = 0.6"}, ("spheres.push_back = 0.6", "at most 0.5")),
    "sticky friction": ({LAW: "friction = -0.5"},
                        ("spheres.contact.friction = -0.5", "at least 0")),
    "bouncing up": ({LAW: "restitution = 1.1"}, ("restitution = 1.1", "at most 1")),
    "misspelt friction": ({LAW: "fricton = 0.5"}, ("spheres.contact.fricton", "'friction'")),
    "stiffness": ({LAW: "stiffness = 1e5"}, ("spheres.contact.stiffness: unknown key",)),
    "negative rolling": ({LAW: "rolling = -0.1"}, ("rolling = -0.1", "at least 0")),
    "rolling without friction": ({LAW: "friction = 0, rolling = 0.1"},
                                 ("spheres.contact.rolling = 0.1: no effect on smooth grains",
                                  "spheres.contact.friction above 0")),
    "rolling of jacobi": ({LAW: "rolling = 0.1", RULE: 'rule = "jacobi"'},
                          ("spheres.contact.rolling = 0.1: not with spheres.solver.rule = 'jacobi'",
                           "'gauss-seidel'")),
    "no cohesion": ({LAW: "cohesion = { force = 0, range = 0.1 }"},
                    ("spheres.contact.cohesion.force = 0", "above 0")),
    "cohesion without range": ({LAW: "cohesion = { force = 1 }"},
                               ("spheres.contact.cohesion", "range")),
    "cohesion far away": ({LAW: PULL.replace("0.01", "0.3")},
                          ("spheres.contact.cohesion.range = 0.3: expected less than the skin",
                           "0.25 (spheres.skin)")),
    "cohesion that fills the skin": ({LAW: PULL.replace("0.01", "0.24999")},
                                     ("spheres.timestep = 0.002: grains pass",)),
    "misspelt solver": ({RULE: 'rule = "gauss-siedel"'},
                        ("spheres.solver.rule = 'gauss-siedel'", "'gauss-seidel'")),
    "order": ({RULE: 'rule = "gauss-seidel", order = "colored"'},
              ("spheres.solver.order = 'colored'", "'coloured'")),
    "no sweeps": ({RULE: 'rule = "gauss-seidel", sweeps = 0'},
                  ("spheres.solver.sweeps = 0", "at least 1")),
    "tolerance": ({RULE: 'rule = "gauss-seidel", tolerance = -1'},
                  ("spheres.solver.tolerance = -1", "at least 0")),
    "relaxation of gauss-seidel": ({RULE: 'rule = "gauss-seidel", relaxation = 0.5'},
                                   ("spheres.solver.relaxation: unknown key",)),
    "no relaxation": ({RULE: 'rule = "jacobi", relaxation = 0'}, ("relaxation = 0", "above 0")),
    "order of jacobi": ({RULE: 'rule = "jacobi", order = "random"'},
                        ("spheres.solver.order: unknown key",)),
    "spin of smooth grains": ({LAW: "friction = 0", STEP: "spin_kT = 0.7"},
                              ("spheres.spin_kT = 0.7: no effect", "spheres.contact.friction")),
    "denser than packed": ({"number = 30": "packing_fraction = 0.95"},
                           ("a packing fraction of 0.95", "at most 0.9069")),
    "lattice too dense": ({"number = 30": "number = 210"},
                          ("spheres.start.rule = 'lattice'", "overlap")),
    "plate that leaves": ({"lower = {": "lower = { velocity = [0, 1],"},
                          ("wall[#1].lower.velocity = [0, 1]", "along itself")),
    "vibration without room": ({OWN: "{ amplitude = 9.8, frequency = 0.01 }"},
                               ("contact.amplitude = 9.8", "leaves 0.7", "less than 9.5")),
    "half a vibration": ({OWN: "{ amplitude = 0.1 }"},
                         ("wall[#1].lower.contact.amplitude = 0.1: a vibration has an amplitude",)),
    "disk that is pushed": (
        {**FREE, WALL: DISK + "surface = { contact = { force = 1.0 } }\n",
         "number = 30": 'number = 30\nstart = { rule = "random" }'},
        ("wall[#1].surface.contact.force = 1: only plates move",)),
    "moved and pushed": ({OWN: "{ speed = 0.1, force = 1 }"},
                         ("wall[#1].lower.contact.speed", "not with", "contact.force")),
    "force and pressure": ({OWN: "{ force = 1, pressure = 1 }"},
                           ("wall[#1].lower.contact.force", "not with", "contact.pressure")),
    "vibrates and moves": ({OWN: "{ amplitude = 0.1, frequency = 1, speed = 0.1 }"},
                           ("wall[#1].lower.contact.speed", "not with", "contact.amplitude")),
    "travel of nothing": ({OWN: "{ travel = 1 }"},
                          ("wall[#1].lower.contact.travel = 1", "contact.speed as well")),
    "mass of nothing": ({OWN: "{ mass = 1 }"},
                        ("wall[#1].lower.contact.mass = 1", "contact.force or")),
    "pulled plate": ({OWN: "{ force = -1 }"}, ("contact.force = -1", "above 0")),
    "opened before": ({'shape = "plates"': 'shape = "plates"\nopens = 0'},
                      ("wall[#1].opens = 0", "above 0")),
    "motion of what rests": ({'"wall-force"': '"plate-motion"'},
                             ("plate-motion", "no plate moves", "contact.speed")),
    "rough wall": ({OWN: "{ tangential = 0.5 }"},
                   ("wall[#1].lower.contact.tangential = 0.5: not with method",)),
    "hot wall": ({OWN: "{ temperature = 1 }"},
                 ("wall[#1].lower.contact.temperature = 1: not with method",)),
    "diffuse wall": ({"lower = {": 'lower = { rule = "diffuse",'},
                     ("wall[#1].lower.rule = 'diffuse'", "'no-slip' or 'slip'")),
    "friction of slip": ({"lower = {": 'lower = { rule = "slip",', OWN: "{ friction = 0.2 }"},
                         ("wall[#1].lower.contact.friction = 0.2: no effect", "'slip'")),
    "disk that vibrates": (
        {**FREE, WALL: DISK + 'surface = { contact = { amplitude = 0.1, frequency = 1 } }\n',
         "number = 30": 'number = 30\nstart = { rule = "random" }'},
        ("amplitude = 0.1: only plates vibrate",)),
    "endless fall": ({"[0, -1]": "[1, 0]"}, ("spheres.gravity", "ends the fall along x")),
    "no wall below": ({WALL: "", OBSERVED: ""}, ("spheres.gravity", "expected a wall")),
    "gravity of 3D": ({"[0, -1]": "[0, 0, -1]"}, ("spheres.gravity", "2 numbers")),
    "narrow box": ({"[20, 10.5]": "[1.9, 90]"},
                   ("box.size", "twice the largest diameter (2)", "along x")),
    "sheared between plates": ({**SHEAR, WALL: WALL},
                               ("box.shear_rate = 0.1: not with wall[#1].axis = 'y'", "plates")),
    "sheared beside a disk": (
        {**SHEAR, WALL: DISK, "number = 30": 'number = 30\nstart = { rule = "random" }'},
        ("box.shear_rate = 0.1: not with wall[#1].shape = 'disk'",)),
    "place on a line": (
        {**FREE, WALL: DISK.replace("[5, 5]", "[5, 5, 5]")},
        ("wall[#1].centre = [5, 5, 5]: expected 2 numbers, one for each axis of the 2D box",)),
    "sheared and falling": ({**SHEAR, "gravity = [0, -1]": "gravity = [0, -1]"},
                            ("box.shear_rate = 0.1: not with spheres.gravity = [0, -1]",
                             "repeats along y")),
    "sheared and low": ({**SHEAR, "[20, 10.5]": "[20, 3.5]\nshear_rate = 0.1",
                         "number = 30": "number = 10"},
                        ("box.shear_rate = 0.1: box.size = [20, 3.5]", "at least 3.75 along y")),
    "observable of soft spheres": ({'"wall-force"': '"free-times"'},
                                   ("observe[#1].quantity = 'free-times'", "does not offer it")),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_wrong_cases_are_refused(name, tmp_path: Path, capsys):
    changes, words = BAD[name]
    file = tmp_path / "case.toml"
    file.write_text(changed(GOOD, changes))
    has_words(refused(capsys, "check", file), words)


def test_the_good_case_passes(tmp_path: Path, capsys):
    file = tmp_path / "case.toml"
    file.write_text(GOOD)
    with pytest.raises(SystemExit) as end:
        main(["check", str(file)])
    assert end.value.code == 0
    told = capsys.readouterr().out
    for words in ("friction angle", "sweeps needed", "contacts", "as soft spheres", "run time"):
        assert words in told
