"""Wrong cases: each is refused with one line that names the key, before anything is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit.cli import main
from tests.helpers.refusals import changed, has_words, refused

GOOD = """
title = "slit"
[run]
steps = 10
[box]
size = [20, 10]
[fluid]
density = 5
timestep = 0.1
collision = { rule = "srd", angle = 90 }
thermostat = { rule = "maxwell-boltzmann" }
force = { rule = "uniform", acceleration = [0.001, 0] }
[[wall]]
shape = "plates"
axis = "y"
lower = { rule = "no-slip", velocity = [0, 0] }
[[observe]]
quantity = "velocity-profile"
axis = "y"
"""
ANGLE = 'collision = { rule = "srd", angle = 90 }'
FORCE = 'force = { rule = "uniform", acceleration = [0.001, 0] }'
WALL = GOOD[GOOD.index("[[wall]]") : GOOD.index("[[observe]]")]
BOND = 'bond = { rule = "harmonic", K = 1 }'
MOLECULE = "[fluid]\nmolecule = {{ bond = {{ rule = {} }} }}"
CUBE = {"[20, 10]": "[10, 10, 10]", "[0.001, 0]": "[0.001, 0, 0]", "[0, 0]": "[0, 0, 0]"}

SOLUTES = (
    "[solutes]\npolymers = [{ number = 2, length = 4 }, { number = 3 }]\n" + BOND + "\n[fluid]"
)
RANDOM = SOLUTES.replace("bond =", 'solvent = "random"\nbond =')
PUSHED = (
    '[solutes]\npolymers = [{ number = 2 }]\ncoupling = "potential"\n'
    'solvent_pair = { rule = "wca", sigma = 2.0 }\n[fluid]'
)
PROFILE = 'quantity = "velocity-profile"\naxis = "y"'
# name: (what is replaced by what in the good case, what the message must say)
BAD: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    # syntax and structure
    "syntax": ({"steps = 10": "steps = = 10"}, ("line 4", "TOML")),
    "key twice": ({"steps = 10": "steps = 10\nsteps = 11"}, ("line 5", "TOML")),
    "end of file": ({'axis = "y"\n': 'axis = "y'}, ("TOML",)),
    "unknown table": ({"[box]": "[boxes]"}, ("boxes: unknown key", "'box'")),
    "unknown top key": ({'title = "slit"': 'titel = "slit"'}, ("titel: unknown key", "'title'")),
    "plural": ({"[[wall]]": "[[walls]]"}, ("walls: unknown key", "[[wall]]")),
    "single brackets": ({"[[wall]]": "[wall]"}, ("wall:", "[[wall]]")),
    "no run": ({"[run]\nsteps = 10\n": ""}, ("run: missing",)),
    "no steps": ({"steps = 10": "warmup = 5"}, ("run.steps: missing",)),
    "no size": ({"size = [20, 10]": ""}, ("box.size: missing",)),
    "number for a table": ({"[box]\nsize = [20, 10]\n": "", '"slit"': '"slit"\nbox = 3'},
                           ("box = 3", "table")),
    "misspelt tag": ({'shape = "plates"': 'shpe = "plates"'},
                     ("wall[#1].shape: missing", "is 'shpe' meant", "'plates'")),
    # beyond what numbers can hold
    "crowd": ({"density = 5": "density = 1e300"}, ("fluid.density = 1e+300", "at most 1e+12")),
    "hasty shear": ({"size = [20, 10]": "size = [20, 10]\nshear_rate = 1e300"},
                    ("box.shear_rate = 1e+300", "at most 1e+06")),
    "short bond": ({"[fluid]": MOLECULE.format('"fene", R0 = 1e-300')},
                   ("fluid.molecule.bond.R0 = 1e-300", "at least 0.001")),
    "stiff bond": ({"[fluid]": MOLECULE.format('"harmonic", K = 1e300')},
                   ("fluid.molecule.bond.K = 1e+300", "at most 1e+09")),
    # solutes
    "no bond": ({"[fluid]": SOLUTES.replace(BOND, "")}, ("solutes.bond: missing", "length = 4")),
    "no beads": ({"[fluid]": SOLUTES.replace("length = 4", "length = 0")},
                 ("solutes.polymers[#1].length = 0",)),
    "uneven star": ({"[fluid]": SOLUTES.replace("= 4", '= 5, topology = "star", arms = 3')},
                    ("solutes.polymers[#1].length = 5", "nearest is 4")),
    "small ring": ({"[fluid]": SOLUTES.replace("= 4", '= 2, topology = "ring"')},
                   ("solutes.polymers[#1].length = 2", "at least 3")),
    "far pairs": ({"[fluid]": SOLUTES.replace("bond", 'pair = { rule = "wca", sigma = 9 }\nbond')},
                  ("solutes.pair: it reaches 10.1", "box of 20")),
    "monomers have no size": ({"[fluid]": SOLUTES, PROFILE: 'quantity = "molecule-size"\nkind = 2'},
                              ("observe[#1]", "solutes.polymers[#2] are monomers")),
    "no such kind": ({"[fluid]": SOLUTES, PROFILE: 'quantity = "molecule-size"\nkind = 3'},
                     ("observe[#1].kind = 3", "1 to 2")),
    "kind of the fluid": (
        {"[fluid]": SOLUTES, PROFILE: 'quantity = "mean-square-displacement"\nkind = 2\n'
         'components = ["x"]'},
        ("observe[#1].kind = 2", "only with of = 'beads'"),
    ),
    "random solvent and walls": ({"[fluid]": RANDOM}, ("solvent = 'random': not with walls",)),
    "nobody in a random solvent": (
        {"[fluid]": RANDOM, WALL: "", PROFILE: 'quantity = "velocity-autocorrelation"'},
        ("observe[#1].quantity = 'velocity-autocorrelation'", "there is no fluid"),
    ),
    "pushed by nothing": (
        {"[fluid]": PUSHED.replace("solvent_pair", "wall")},
        ("solutes.solvent_pair: missing", "coupling = 'potential' needs it"),
    ),
    "pushed without saying so": (
        {"[fluid]": PUSHED.replace('coupling = "potential"\n', "")},
        ("solutes.solvent_pair: only with coupling = 'potential'",),
    ),
    "pushed by a stress": (
        {"[fluid]": PUSHED, WALL: "", PROFILE: 'quantity = "stress"'},
        ("observe[#1].quantity = 'stress'", "not with solutes.coupling = 'potential'"),
    ),
    "pushed in a sheared box": (
        {"[fluid]": PUSHED, WALL: "", "[box]": "[box]\nshear_rate = 0.1"},
        ("coupling = 'potential': not in a sheared box",),
    ),
    "pushed from both sides": (
        {"[fluid]": PUSHED.replace("2.0", "12.0"), WALL: ""},
        ("solutes.solvent_pair: it reaches 13.5, more than half of the box",),
    ),
    "no room left": (
        {"[fluid]": PUSHED.replace("number = 2", "number = 40")},
        ("solutes.solvent_pair: 40 beads exclude the fluid", "fewer or smaller beads"),
    ),
    # typos
    "unknown key": ({"density = 5": "densty = 5"}, ("fluid.densty: unknown key", "'density'")),
    "unknown nested key": ({"angle = 90": "angel = 90"}, ("fluid.collision.angel", "'angle'")),
    "dashes for underscores": ({"density = 5": "grid-shift = 1"}, ("grid-shift", "'grid_shift'")),
    "unknown rule": ({'"srd"': '"sdr"'}, ("fluid.collision.rule = 'sdr'", "'srd'", "'at+a'")),
    "no rule": ({'{ rule = "srd", angle = 90 }': "{ angle = 90 }"}, ("collision.rule: missing",)),
    "key of another rule": ({'"srd"': '"at"'}, ("fluid.collision.angle: unknown key", "rule")),
    "unknown thermostat": ({'"maxwell-boltzmann"': '"nose-hoover"'}, ("fluid.thermostat.rule",)),
    "unknown quantity": ({'"velocity-profile"': '"velocity-profil"'},
                         ("observe[#1].quantity", "'velocity-profile'")),
    "unknown key of an observable": ({'quantity = "velocity-profile"\naxis':
                                      'quantity = "velocity-profile"\naxes'},
                                     ("observe[#1].axes", "'axis'")),
    "unknown surface": ({'"no-slip"': '"noslip"'}, ("wall[#1].lower.rule", "'no-slip'")),
    "unknown shape": ({'"plates"': '"plate"'}, ("wall[#1].shape = 'plate'", "'plates'")),
    "unknown method": ({"steps = 10": 'steps = 10\nmethod = "lbm"'}, ("run.method", "'mpcd'")),
    "misspelt method": ({"steps = 10": 'steps = 10\nmethod = "brownien"', "[fluid]": "[brownian]"},
                        ("run.method = 'brownien'", "'brownian'")),
    "method of another type": ({"steps = 10": "steps = 10\nmethod = 3"}, ("run.method = 3",)),
    # types
    "text for a number": ({"density = 5": 'density = "five"'}, ("fluid.density = 'five'",)),
    "boolean for a number": ({"density = 5": "density = true"}, ("fluid.density = true",)),
    "half a step": ({"steps = 10": "steps = 10.5"}, ("run.steps = 10.5", "whole number")),
    "no number of steps": ({"steps = 10": "steps = nan"}, ("run.steps = nan", "whole number")),
    "half a cell": ({"[20, 10]": "[20, 10.5]"}, ("box.size[#2] = 10.5", "whole number")),
    "number for a list": ({"[20, 10]": "20"}, ("box.size = 20", "list")),
    "number for a text": ({'"slit"': "3"}, ("title = 3", "text")),
    "infinity": ({"density = 5": "density = inf"}, ("fluid.density = inf", "finite")),
    "not a number": ({"timestep = 0.1": "timestep = nan"}, ("fluid.timestep = nan", "finite")),
    # ranges
    "negative density": ({"density = 5": "density = -5"}, ("fluid.density = -5", "above 0")),
    "no timestep": ({"timestep = 0.1": "timestep = 0"}, ("fluid.timestep = 0", "at least 1e-06")),
    "negative steps": ({"steps = 10": "steps = -1"}, ("run.steps = -1", "at least 0")),
    "large seed": ({"steps = 10": "steps = 10\nseed = 72057594037927936"}, ("run.seed",)),
    "angle too large": ({"angle = 90": "angle = 200"}, ("fluid.collision.angle = 200", "180")),
    "angle zero": ({"angle = 90": "angle = 0"}, ("fluid.collision.angle = 0", "above 0")),
    "strong shift": ({"density = 5": "grid_shift = 1.5"}, ("fluid.grid_shift = 1.5", "most 1")),
    "one cell": ({"[20, 10]": "[20, 1]"}, ("box.size", "at least 2")),
    "one dimension": ({"[20, 10]": "[20]"}, ("box.size", "2D", "3D")),
    "four dimensions": ({"[20, 10]": "[4, 4, 4, 4]"}, ("box.size", "2D", "3D")),
    "huge box": ({"[20, 10]": "[1000000000, 1000000000]"}, ("box.size", "cells")),
    "empty box": ({"density = 5": "density = 0.001"}, ("fluid.density", "particles")),
    "every 0": ({"[[observe]]": "[[observe]]\nevery = 0"},
                ("observe[#1].every = 0", "at least 1")),
    "negative species": ({"density = 5": "species = [{ mass = -1, density = 5 }]"},
                         ("fluid.species[#1].mass = -1",)),
    "compression": ({"[[wall]]": "[trajectory]\nevery = 5\ncompression = 12\n[[wall]]"},
                    ("trajectory.compression = 12", "at most 9")),
    "long timestep": ({"timestep = 0.1": "timestep = 1001"}, ("fluid.timestep", "at most 1000")),
    "molecule without a bond": ({"density = 5": "molecule = { length = 2 }"},
                                ("fluid.molecule.bond: missing",)),
    "bond without a constant": ({"density = 5": 'molecule = { bond = { rule = "harmonic" } }'},
                                ("fluid.molecule.bond.K: missing",)),
    "constant of the other convention":
        ({"density = 5": 'molecule = { bond = { rule = "harmonic", k = 1 } }'},
         ("fluid.molecule.bond.k: unknown key", "'K'")),
    "unknown bond": ({"density = 5": 'molecule = { bond = { rule = "harmonics", K = 1 } }'},
                     ("fluid.molecule.bond.rule = 'harmonics'", "'harmonic'")),
    "unequal molecules": ({"density = 5": "molecule = { length = 7, " + BOND + " }"},
                          ("fluid.molecule.length = 7", "2000 particles", "fluid.density = 10.01")),
    "star without arms": ({"density = 5": 'molecule = { topology = "star", ' + BOND + " }"},
                          ("fluid.molecule", "arms: missing")),
    "arms of unequal length":
        ({"density = 5": 'molecule = { topology = "star", length = 5, arms = 3, ' + BOND + " }"},
         ("length = 5", "nearest is 4")),
    "arms of a chain": ({"density = 5": "molecule = { arms = 3, " + BOND + " }"},
                        ("arms = 3", "star")),
    "ring of two": ({"density = 5": 'molecule = { topology = "ring", ' + BOND + " }"},
                    ("length = 2", "at least 3")),
    "unstable sub-step":
        ({"density = 5": 'molecule = { substeps = 1, bond = { rule = "harmonic", K = 500 } }'},
         ("fluid.molecule.substeps = 1", "unstable", "at least")),
    "bond longer than half the box":
        ({"density = 5": 'molecule = { bond = { rule = "harmonic", K = 0.01 } }'},
         ("fluid.molecule.bond", "half of the box", "10")),
    "molecules and species":
        ({"density = 5": "species = [{ mass = 1, density = 5 }]\nmolecule = { " + BOND + " }"},
         ("fluid.species", "fluid.molecule")),
    "exact chains":
        ({"density = 5": 'molecule = { length = 4, propagation = "exact", ' + BOND + " }"},
         ("propagation = 'exact'", "length = 2")),
    "exact dimers between plates":
        ({"density = 5": 'molecule = { propagation = "exact", ' + BOND + " }"},
         ("fluid.molecule.propagation = 'exact'", "walls")),
    "bond-length without bonds": ({'"velocity-profile"\naxis = "y"': '"bond-length"'},
                                  ("observe[#1]", "fluid.molecule")),
    "no mass": ({"density = 5": "mass = 1e-4"}, ("fluid.mass = 0.0001", "at least 0.001")),
    "heavy species": ({"density = 5": "species = [{ mass = 1001, density = 5 }]"},
                      ("fluid.species[#1].mass = 1001", "at most 1000")),
    "cold": ({"density = 5": "kT = 1e-7"}, ("fluid.kT = 1e-07", "at least 1e-06")),
    # combinations
    "long mean free path": ({"timestep = 0.1": "timestep = 11"},
                            ("fluid.timestep = 11", "mean free path", "at most 10")),
    "too many particles": (
        {"[20, 10]": "[100000, 100000]", "density = 5": "density = 1e8"},
        ("fluid.density", "at most 9007199"),
    ),
    "too many bins": ({"[[observe]]": "[[observe]]\nbins_per_cell = 100_000_000"},
                      ("observe[#1].bins_per_cell = 100000000", "at most 16777216")),
    "too many bins of a map": ({'"velocity-profile"\naxis = "y"':
                                '"velocity-field"\nbins_per_cell = 1000'},
                               ("observe[#1].bins_per_cell = 1000", "200000000 bins")),
    "axis z in 2D": ({'axis = "y"\nlower': 'axis = "z"\nlower'}, ("wall[#1].axis = 'z'", "2D")),
    "observed axis z in 2D": ({'profile"\naxis = "y"': 'profile"\naxis = "z"'},
                              ("observe[#1].axis = 'z'", "2D")),
    "long vector": ({"[0.001, 0]": "[0.001, 0, 0]"}, ("fluid.force.acceleration", "2 numbers")),
    "long plate velocity": ({"[0, 0]": "[0, 0, 0]"}, ("wall[#1].lower.velocity", "2 numbers")),
    "plate through the fluid": ({"[0, 0]": "[0, 0.1]"}, ("wall[#1].lower.velocity", "itself")),
    "slip plate that drags": ({'"no-slip", velocity = [0, 0]': '"slip", velocity = [0.1, 0]'},
                              ("wall[#1].lower.velocity", "slip")),
    "two slits": ({"[[wall]]": '[[wall]]\nshape = "plates"\naxis = "y"\n[[wall]]'},
                  ("wall[#2].axis", "closes it already")),
    "shear in a slit": ({"[20, 10]": "[20, 10]\nshear_rate = 0.1"}, ("box.shear_rate", "walls")),
    "shear and a sine": ({"[20, 10]": "[20, 10]\nshear_rate = 0.1", WALL: "",
                          FORCE: 'force = { rule = "sinusoidal", amplitude = 0.1 }'},
                         ("box.shear_rate", "sinusoidal")),
    "shear and a force across": ({"[20, 10]": "[20, 10]\nshear_rate = 0.1", WALL: "",
                                  "[0.001, 0]": "[0, 0.001]"}, ("box.shear_rate", "along y")),
    "two thermostats": ({ANGLE: 'collision = { rule = "at" }'},
                        ("fluid.thermostat.rule", "'at'", "own thermostat")),
    "uniform angle in 3D": (CUBE | {"angle = 90": 'angle_distribution = "uniform"'},
                            ("fluid.collision.angle_distribution", "2D")),
    "angle without effect": ({"angle = 90": 'angle = 90, angle_distribution = "uniform"'},
                             ("fluid.collision.angle = 90", "no effect")),
    "half turn in 2D": ({"angle = 90": "angle = 180"}, ("fluid.collision.angle = 180", "2D")),
    "wave along itself": ({FORCE: 'force = { rule = "sinusoidal", amplitude = 0.1, flow = "y" }'},
                          ("fluid.force.gradient", "flow")),
    "density and species": ({"density = 5": "density = 5\nspecies = [{ mass = 1, density = 3 }]"},
                            ("fluid", "density = 5", "species")),
    "same name twice": ({"[[observe]]": '[[observe]]\nquantity = "velocity-profile"\n[[observe]]'},
                        ("observe[#2].name", "'velocity-profile'")),
    "name of no file": ({"[[observe]]": '[[observe]]\nname = "a/b"'},
                        ("observe[#1].name = 'a/b'", "letters")),
    "missing start file": ({"density = 5": 'start = { positions = "none.npy" }'},
                           ("fluid.start.positions", "none.npy", "no such file")),
    "two starts": ({"density = 5": 'start = { run = "a", positions = "b.npy" }'},
                   ("fluid.start.run", "positions")),
    "units without a length": ({"[[wall]]": '[units]\nmatch = "reynolds"\n[[wall]]'},
                               ("units.cell: missing",)),
    "units without a match": ({"[[wall]]": "[units]\ncell = 1e-6\n[[wall]]"},
                              ("units.match: missing",)),
    "units of Schmidt": ({"[[wall]]": '[units]\ncell = 1e-6\nmatch = "schmidt"\n[[wall]]'},
                         ("units.match = 'schmidt'", "'thermal'")),
    "units of Brownian motion in 2D":
        ({"[[wall]]": '[units]\ncell = 1e-6\nmatch = "peclet"\n[[wall]]'},
         ("units.match = 'peclet'", "3D")),
    "water in degrees Celsius":
        ({"[[wall]]": '[units]\ncell = 1e-6\nmatch = "reynolds"\n'
          'fluid = { substance = "water", temperature = 25 }\n[[wall]]'},
         ("units.fluid.temperature = 25", "273.15")),
    "large subset": ({"[[wall]]": "[trajectory]\nevery = 5\nsubset = 2000\n[[wall]]"},
                     ("trajectory.subset = 2000", "1000")),
    "field twice": ({"[[wall]]": '[trajectory]\nevery = 5\nfields = ["id", "id"]\n[[wall]]'},
                    ("trajectory.fields",)),
}  # fmt: skip


def test_the_good_case_is_good(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "good.toml").write_text(GOOD)
    with pytest.raises(SystemExit) as end:
        main(["check", str(tmp_path / "good.toml")])
    assert end.value.code == 0
    assert "Reynolds" in capsys.readouterr().out


@pytest.mark.parametrize(("given", "hint"), [("turnover", True), ("sdr", False)])
def test_an_unknown_rule_may_be_a_part_of_ones_own(given, hint, tmp_path, capsys) -> None:
    """The message says how it is imported, unless a rule of mesokit is meant."""
    file = tmp_path / "own.toml"
    file.write_text(GOOD.replace('rule = "srd"', f'rule = "{given}"'))
    message = refused(capsys, "check", file)
    assert f"fluid.collision.rule = {given!r}: expected 'at'" in message
    assert ("mesokit --import MODULE" in message) is hint
    assert ("did you mean 'srd'?" in message) is not hint


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize("name", BAD)
def test_bad_case_is_refused(
    name: str, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch
) -> None:
    changes, expected = BAD[name]
    text = changed(GOOD, changes, 1)
    (tmp_path / "bad.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    message = refused(capsys, command, "bad.toml")
    assert "bad.toml: " in message
    has_words(message, expected)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.toml"]
    assert (tmp_path / "bad.toml").read_text() == text
