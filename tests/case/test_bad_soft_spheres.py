"""Wrong cases of soft spheres: each is refused with one line that names the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit.cli import main
from tests.helpers.refusals import changed, has_words, refused

GOOD = """
[run]
steps = 10
method = "soft-spheres"
[box]
size = [20, 10.5]
[spheres]
number = 30
timestep = 0.0002
kinds = [{ diameter = 1 }]
pair = { rule = "spring-dashpot", restitution = 0.9, contact_time = 0.01 }
gravity = [0, -1]
[[wall]]
shape = "plates"
axis = "y"
lower = { contact = { restitution = 0.8 } }
[[observe]]
quantity = "mean-square-displacement"
every = 2
max_lag = 4
"""
WALL = GOOD[GOOD.index("[[wall]]") : GOOD.index("[[observe]]")]
PAIR = GOOD[GOOD.index("pair") : GOOD.index("gravity")]
RULE = 'rule = "spring-dashpot", restitution = 0.9, contact_time = 0.01'
LJ = {RULE: 'rule = "lennard-jones"', "{ contact = { restitution = 0.8 } }": "{}"}
# name: (what is replaced by what in the good case, what the message must say)
BAD: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    "misspelt method": ({'"soft-spheres"': '"soft-sphere"'}, ("run.method", "'soft-spheres'")),
    "section of another method": ({"[spheres]": "[fluid]"},
                                  ("fluid: unknown key", "a section of 'mpcd' (run.method)")),
    "misspelt key": ({"number = 30": "nunber = 30"}, ("spheres.nunber", "'number'")),
    "key of event-driven": ({"timestep = 0.0002": 'collision = { rule = "hard" }'},
                            ("spheres.collision: unknown key",)),
    "no spheres": ({"number = 30": "number = 0"}, ("spheres.number = 0", "at least 1")),
    "overfull": ({"number = 30": "packing_fraction = 1.2"}, ("packing_fraction = 1.2", "below 1")),
    "no time": ({"timestep = 0.0002": "timestep = 0"}, ("spheres.timestep = 0", "above 0")),
    "coarse": ({"timestep = 0.0002": "timestep = 0.002"}, ("spheres.timestep = 0.002", "tenth")),
    "no skin": ({"timestep = 0.0002": "skin = 0"}, ("spheres.skin = 0", "above 0")),
    "thick skin": ({"timestep = 0.0002": "skin = 10"}, ("spheres.skin", "less than 9", "along x")),
    "misspelt rule": ({'"spring-dashpot"': '"spring-dashpt"'}, ("pair.rule", "spring-dashpot")),
    "key of another rule": ({"restitution = 0.9": "epsilon = 1"}, ("pair.epsilon: unknown",)),
    "bouncing up": ({"restitution = 0.9": "restitution = 1.1"}, ("at most 1",)),
    "no restitution": ({"restitution = 0.9": "restitution = 0"}, ("restitution = 0", "above 0")),
    "no contact time": ({"contact_time = 0.01": "contact_time = 0"}, ("contact_time = 0",)),
    "time and stiffness": ({"restitution = 0.9": "stiffness = 1"}, ("pair", "not both")),
    "damping alone": ({"restitution = 0.9": "damping = 1"}, ("pair", "expected a stiffness")),
    "damping and restitution": ({"contact_time = 0.01": "stiffness = 9, damping = 1"},
                                ("pair", "not both")),
    "plate that leaves": ({"lower = {": "lower = { velocity = [0, 1],"},
                          ("wall[#1].lower.velocity = [0, 1]", "along itself")),
    "vibration without room": ({"{ restitution = 0.8 }": "{ amplitude = 9.8, frequency = 1 }"},
                               ("contact.amplitude = 9.8", "leaves 0.7", "less than 9.5")),
    "negative friction": ({"restitution = 0.9": "friction = -1"}, ("friction = -1", "at least 0")),
    "kind of friction": ({"restitution = 0.9": 'tangential = "spring"'},
                         ("pair.tangential = 'spring'", "'history' or 'viscous'")),
    "rolling": ({"restitution = 0.9": "rolling = -0.1"}, ("rolling = -0.1", "at least 0")),
    "stiffness of hertz": ({RULE: 'rule = "hertz", stiffness = 0'}, ("stiffness = 0", "above 0")),
    "thermostat": ({"timestep = 0.0002": 'thermostat = { rule = "andersen" }'},
                   ("thermostat.rule = 'andersen'", "'langevin'")),
    "no friction of a bath": ({"timestep = 0.0002":
                               'thermostat = { rule = "langevin", friction = 0 }'},
                              ("thermostat.friction = 0", "above 0")),
    "never scaled": ({"timestep = 0.0002": 'thermostat = { rule = "rescale", every = 0 }'},
                     ("thermostat.every = 0", "at least 1")),
    "gravity of 3D": ({"[0, -1]": "[0, 0, -1]"}, ("spheres.gravity", "2 numbers")),
    "endless fall": ({"[0, -1]": "[1, 0]"}, ("spheres.gravity", "ends the fall along x")),
    "no wall below": ({WALL: ""}, ("spheres.gravity", "expected a wall")),
    "diffuse wall": ({"lower = {": 'lower = { rule = "diffuse",'},
                     ("wall[#1].lower.rule = 'diffuse'",)),
    "rough wall": ({"{ restitution = 0.8 }": "{ tangential = 0.5 }"},
                   ("wall[#1].lower.contact.tangential = 0.5: not",)),
    "wall that swallows": ({"{ restitution = 0.8 }": "{ restitution = 0 }"},
                           ("wall[#1].lower.contact.restitution = 0", "more than 0")),
    "half a vibration": ({"{ restitution = 0.8 }": "{ amplitude = 0.1 }"},
                         ("wall[#1].lower.contact.amplitude = 0.1: a vibration has an amplitude",)),
    "plate that moves in 3D": ({"contact = { restitution = 0.8 }": "velocity = [1, 0, 0]"},
                               ("wall[#1].lower.velocity = [1, 0, 0]: expected 2 numbers",)),
    "potential with restitution": ({RULE: 'rule = "wca"'},
                                   ("wall[#1].lower.contact.restitution = 0.8: a potential",)),
    "diameter of a potential": ({**LJ, "diameter = 1": "diameter = 0.5"},
                                ("spheres.kinds", "expected that of the potential")),
    "spin of smooth spheres": ({"timestep = 0.0002": "spin_kT = 0.7"},
                               ("spheres.spin_kT = 0.7: no effect", "spheres.pair.friction")),
    "speed of a potential": ({**LJ, "timestep = 0.0002": "speed = 4"},
                             ("spheres.speed = 4: only for laws of contact", "spheres.timestep")),
    "no speed": ({"timestep = 0.0002": "speed = 0"}, ("spheres.speed = 0", "above 0")),
    "spin of a potential": ({**LJ, "timestep = 0.0002": "spin_kT = 2"},
                            ("spheres.spin_kT = 2: no effect",)),
    "spread of a potential": ({**LJ, "diameter = 1": "spread = 0.1"}, ("one diameter",)),
    "narrow box": ({**LJ, "[20, 10.5]": "[4, 40]"}, ("box.size", "twice the reach", "along x")),
    "shear": ({"[20, 10.5]": "[20, 10.5]\nshear_rate = 0.1"},
              ("box.shear_rate = 0.1: not with method",)),
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
    for words in ("contact time", "steps per contact", "packing fraction", "overlap", "run time"):
        assert words in told
