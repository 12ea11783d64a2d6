"""Wrong cases of event-driven dynamics: each is refused with one line that names the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit import Box, Case, CaseError, HardSpheres, Run, Simulation, SoftSpheres
from mesokit.cli import main
from tests.helpers.refusals import changed, has_words, refused

GOOD = """
[run]
steps = 10
method = "event-driven"
[box]
size = [20, 10.5]
[spheres]
number = 30
timestep = 0.1
kinds = [{ diameter = 1 }]
collision = { rule = "hard", restitution = 0.9 }
gravity = [0, -1]
start = { rule = "lattice" }
[[wall]]
shape = "plates"
axis = "y"
lower = { contact = { restitution = 0.8 } }
[[observe]]
quantity = "granular-temperature"
every = 2
"""
WALL = GOOD[GOOD.index("[[wall]]") : GOOD.index("[[observe]]")]
# name: (what is replaced by what in the good case, what the message must say)
BAD: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    "misspelt method": ({'"event-driven"': '"event-drivn"'}, ("run.method", "'event-driven'")),
    "section of another method": ({"[spheres]": "[fluid]"}, ("fluid: unknown key", "event-driven")),
    "misspelt section": ({"[spheres]": "[sphere]"}, ("sphere: unknown key", "'spheres'")),
    "misspelt key": ({"number = 30": "nunber = 30"}, ("spheres.nunber", "'number'")),
    "no spheres": ({"number = 30": "number = 0"}, ("spheres.number = 0", "at least 1")),
    "half a sphere": ({"number = 30": "number = 1.5"}, ("spheres.number = 1.5", "whole number")),
    "number and density": ({"number = 30": "number = 30\ndensity = 1"}, ("spheres", "not both")),
    "overfull": ({"number = 30": "packing_fraction = 1.2"}, ("packing_fraction = 1.2", "below 1")),
    "too many for the box": ({"number = 30": "number = 300"}, ("spheres", "less than 1")),
    "no room on the lattice": ({"number = 30": "packing_fraction = 0.9"}, ("overlap", "'random'")),
    "negative fraction": ({"number = 30": "packing_fraction = -1"}, ("above 0",)),
    "no kinds": ({"[{ diameter = 1 }]": "[]"}, ("spheres.kinds",)),
    "no diameter": ({"diameter = 1": "diameter = 0"}, ("kinds[#1].diameter = 0", "above 0")),
    "narrow box": ({"diameter = 1": "diameter = 9", "[20, 10.5]": "[10, 90]",
                    "number = 30": "number = 1"}, ("box.size", "two diameters", "along x")),
    "spread": ({"diameter = 1": "spread = 1"}, ("kinds[#1].spread = 1", "below 1")),
    "mass and density": ({"diameter = 1": "mass = 1, density = 1"}, ("kinds[#1]", "not both")),
    "no mass": ({"diameter = 1": "mass = 0"}, ("kinds[#1].mass = 0", "above 0")),
    "large diameter": ({"diameter = 1": "diameter = 11", "[20, 10.5]": "[40, 10.5]",
                        "number = 30": "number = 1"}, ("spheres", "a diameter of 11", "walls")),
    "no time": ({"timestep = 0.1": "timestep = 0"}, ("spheres.timestep = 0", "above 0")),
    "negative kT": ({"timestep = 0.1": "kT = -1"}, ("spheres.kT = -1", "at least 0")),
    "rule": ({'"hard"': '"soft"'}, ("spheres.collision.rule = 'soft'", "'hard'")),
    "bouncing up": ({"restitution = 0.9": "restitution = 1.1"}, ("at most 1",)),
    "key of another rule": ({"restitution = 0.9": "depth = 1"}, ("collision.depth: unknown",)),
    "tangential": ({"restitution = 0.9": "tangential = 2"}, ("tangential = 2", "at most 1")),
    "plate that leaves": ({"lower = {": "lower = { velocity = [0, 1],"},
                          ("wall[#1].lower.velocity = [0, 1]", "along itself")),
    "vibration without room": ({"{ restitution = 0.8 }": "{ amplitude = 9.8, frequency = 1 }"},
                               ("contact.amplitude = 9.8", "leaves 0.7", "less than 9.5")),
    "friction of what is smooth": ({"restitution = 0.9": "friction = 0.3"},
                                   ("collision.friction = 0.3", "tangential above -1")),
    "closer than closest": ({"number = 30": "packing_fraction = 0.95",
                             '"lattice"': '"random"'}, ("0.95", "at most 0.9069")),
    "friction": ({"restitution = 0.9": "friction = -1"}, ("friction = -1", "at least 0")),
    "contact time": ({"restitution = 0.9": "contact_time = -1"}, ("contact_time = -1",)),
    "narrow well": ({'"hard", restitution = 0.9': '"square-well", width = 0.5'}, ("above 1",)),
    "long gravity": ({"[0, -1]": "[0, 0, -1]"}, ("spheres.gravity", "2 numbers")),
    "endless fall": ({"[0, -1]": "[1, 0]"}, ("spheres.gravity", "along x", "wall")),
    "text for gravity": ({"[0, -1]": '"down"'}, ("spheres.gravity", "list")),
    "start": ({'"lattice"': '"random", seed = 1'}, ("start.seed: unknown key",)),
    "rule of start": ({'"lattice"': '"lattise"'}, ("start.rule = 'lattise'", "'lattice'")),
    "heating": ({"gravity": 'heating = { rule = "kick" }\ngravity'}, ("heating.rule", "'kicks'")),
    "no power": ({"gravity": 'heating = { rule = "kicks", power = 0 }\ngravity'}, ("power = 0",)),
    "shear": ({"10.5]": "10.5]\nshear_rate = 0.1"}, ("box.shear_rate = 0.1: not", "event-driven")),
    "open box": ({"10.5]": '10.5]\nopen = ["x"]'}, ("box.open", "event-driven")),
    "wall of another kind": ({WALL: '[[wall]]\nshape = "capsule"\nstart = [1, 1]\nend = [2, 2]\n'
                              "radius = 1\n", "10.5": "10"}, ("wall[#1]", "event-driven")),
    "round wall in a box of broken length":
        ({WALL: '[[wall]]\nshape = "disk"\ncentre = [5, 5]\nradius = 2\n'},
         ("wall[#1]", "whole lengths")),
    "sphere in 2D": ({WALL: '[[wall]]\nshape = "sphere"\ncentre = [5, 5]\nradius = 2\n',
                      "10.5": "10"}, ("wall[#1]", "2D")),
    "virtual particles": ({'axis = "y"': 'axis = "y"\nvirtual = "none"'}, ("wall[#1].virtual",)),
    "temperature of a cold wall": ({"restitution = 0.8": "temperature = 2"},
                                   ("wall[#1].lower.contact.temperature = 2", "diffuse")),
    "restitution of a warm wall":
        ({"lower = {": 'lower = { rule = "diffuse",'},
         ("wall[#1].lower.contact.restitution = 0.8: no effect", "'diffuse'", "leave it out")),
    "tangential of a warm wall":
        ({"lower = {": 'lower = { rule = "diffuse",', "restitution = 0.8": "tangential = 0.4"},
         ("wall[#1].lower.contact.tangential = 0.4: no effect",)),
    "friction of a smooth wall":
        ({"restitution = 0.8": "friction = 0.2"},
         ("wall[#1].lower.contact.friction = 0.2: no effect", "lower.contact.tangential above -1")),
    "friction of a mirror":
        ({"lower = {": 'lower = { rule = "slip",',
          "restitution = 0.8": "friction = 0.2, tangential = 0.5"},
         ("wall[#1].lower.contact.friction = 0.2: no effect", "lower.rule than 'slip'")),
    "spin of smooth spheres": ({"timestep = 0.1": "timestep = 0.1\nspin_kT = 0.3"},
                               ("spheres.spin_kT = 0.3: no effect", "tangential above -1")),
    "half a vibration": ({"restitution = 0.8": "amplitude = 0.1"},
                         ("wall[#1].lower.contact.amplitude = 0.1", "contact.frequency as well")),
    "vibration of no size": ({"restitution = 0.8": "frequency = 3"},
                             ("wall[#1].lower.contact.frequency = 3", "contact.amplitude as well")),
    "plate that moves in 3D": ({"contact = { restitution = 0.8 }": "velocity = [1, 0, 0]"},
                               ("wall[#1].lower.velocity = [1, 0, 0]: expected 2 numbers",)),
    "plate that turns": ({"contact = { restitution = 0.8 }": "rotation = 1"},
                         ("wall[#1].lower.rotation = 1: not",)),
    "round wall that vibrates":
        ({WALL: '[[wall]]\nshape = "disk"\ncentre = [5, 5]\nradius = 2\n'
          "surface = { contact = { amplitude = 0.1, frequency = 1 } }\n", "10.5": "10",
          '"lattice"': '"random"', "[0, -1]": "[0, 0]"},
         ("wall[#1].surface.contact.amplitude = 0.1: only plates",)),
    "density beyond all numbers": ({"number = 30": "density = 1e300"},
                                   ("spheres.density = 1e+300", "at most 1e+15")),
    "misspelt contact": ({"restitution = 0.8": "restitusion = 0.8"}, ("restitusion: unknown key",)),
    "observable of a fluid": ({'"granular-temperature"': '"velocity-field"'}, ("observe[#1]",)),
    "pressure beside walls": ({'"granular-temperature"': '"equation-of-state"'},
                              ("observe[#1]", "wall")),
    "temperatures of one kind": ({'"granular-temperature"': '"kind-temperature"'},
                                 ("observe[#1]", "two kinds")),
    "units": ({"[[wall]]": '[units]\ncell = 1e-6\nmatch = "reynolds"\n[[wall]]'}, ("units",)),
}  # fmt: skip


def test_the_good_case_is_good(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "good.toml").write_text(GOOD)
    with pytest.raises(SystemExit) as end:
        main(["check", str(tmp_path / "good.toml")])
    assert end.value.code == 0
    assert "packing fraction" in capsys.readouterr().out


@pytest.mark.parametrize("name", BAD)
def test_bad_case_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch
) -> None:
    changes, expected = BAD[name]
    text = changed(GOOD, changes, 1)
    (tmp_path / "bad.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    message = refused(capsys, "run", "bad.toml")
    has_words(message, expected)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.toml"]


@pytest.mark.parametrize(
    ("method", "section"),
    [("event-driven", "spheres"), ("soft-spheres", "spheres"), ("flock", "flock")],
)
def test_check_tells_how_much_memory_is_missing(method, section, tmp_path, capsys):
    file = tmp_path / "large.toml"
    run = f'[run]\nsteps = 1\nmethod = "{method}"\n'
    file.write_text(f"{run}[box]\nsize = [60000, 60000]\n[{section}]\nnumber = 2100000000\n")
    with pytest.raises(SystemExit) as end:
        main(["check", str(file)])
    assert not end.value.code
    assert "B of memory, this machine has" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("method", "section"), [("event-driven", HardSpheres), ("soft-spheres", SoftSpheres)]
)
def test_more_than_the_memory_is_refused_where_a_run_begins(method, section):
    """And not where a case is read: it may be one for a larger machine."""
    spheres = section(number=2_000_000_000)
    case = Case(run=Run(1, method=method), box=Box([60000, 60000]), spheres=spheres)
    with pytest.raises(CaseError, match=r"spheres\.number = 2000000000: needs .* of memory, this"):
        Simulation(case)
