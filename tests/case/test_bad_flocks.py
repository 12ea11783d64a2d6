"""Wrong cases of flocks: one line, which names key and value and says what was expected."""

from pathlib import Path

import numpy as np
import pytest

from mesokit import Box, Case, CaseError, Flock, Run, Simulation
from tests.helpers.refusals import changed, has_words, refused

GOOD = """
[run]
steps = 10
method = "flock"
[box]
size = [12, 12]
[flock]
density = 2
"""
WALL = '[[wall]]\nshape = "disk"\ncentre = [6, 6]\nradius = 2\n'
PLATES = '[[wall]]\nshape = "plates"\naxis = "y"\n'

# name: (what is replaced in the good case or added at its end, words of the message)
WRONG = {
    "no bird": ({"density = 2": "density = 1e-9"}, ("flock.density = 1e-09", "0 birds", "1 to")),
    "density below 0": ({"density = 2": "density = -2"}, ("flock.density = -2", "above 0")),
    "text for a density": ({"density = 2": 'density = "2"'}, ("flock.density", "a number")),
    "number and density": (
        {"density = 2": "density = 2\nnumber = 5"},
        ("flock.number = 5", "leave one"),
    ),
    "half a bird": ({"density = 2": "number = 2.5"}, ("flock.number = 2.5", "whole number")),
    "density beyond all numbers": (
        {"density = 2": "density = 1e300"},
        ("flock.density = 1e+300", "at most 1e+15"),
    ),
    "density of many digits": (
        {"density = 2": "density = 1e14"},
        ("flock.density = 1e+14: 1.44e+16 birds in this box",),
    ),
    "too many": ({"density = 2": "density = 1e9"}, ("flock.density = 1000000000", "expected 1 to")),
    "no reach": ({"density = 2": "radius = 0"}, ("flock.radius = 0", "above 0")),
    "reach beyond the box": (
        {"density = 2": "radius = 20"},
        ("flock.radius = 20", "at most 16.97"),
    ),
    "speed below 0": ({"density = 2": "speed = -0.5"}, ("flock.speed = -0.5", "above 0")),
    "no speed": ({"density = 2": "speed = 0"}, ("flock.speed = 0", "above 0")),
    "faster than the box": (
        {"density = 2": "speed = 7"},
        ("flock.speed = 7", "half of the box", "6"),
    ),
    "far in all steps": (
        {"steps = 10": "steps = 1000000000000"},
        ("flock.speed", "cannot be counted"),
    ),
    "timestep 0": ({"density = 2": "timestep = 0"}, ("flock.timestep = 0", "at least 1e-09")),
    "misspelt key": ({"density = 2": "desnity = 2"}, ("flock.desnity", "did you mean 'density'")),
    "misspelt section": ({"[flock]": "[flocks]"}, ("flocks: unknown key", "did you mean 'flock'")),
    "another method's section": (
        {"": "[fluid]\ndensity = 10"},
        ("fluid: unknown key of method 'flock'",),
    ),
    "misspelt noise": (
        {"density = 2": 'noise = { rule = "angle" }'},
        ("flock.noise.rule = 'angle'", "'angular'"),
    ),
    "noise without a rule": (
        {"density = 2": "noise = { strength = 1 }"},
        ("flock.noise.rule: missing",),
    ),
    "angle beyond a turn": (
        {"density = 2": 'noise = { rule = "angular", strength = 7 }'},
        ("flock.noise.strength = 7", "at most 6.28"),
    ),
    "vector too long": (
        {"density = 2": 'noise = { rule = "vectorial", strength = 2 }'},
        ("flock.noise.strength = 2", "at most 1"),
    ),
    "unknown order": (
        {"density = 2": 'order = "orignal"'},
        ("flock.order = 'orignal'", "did you mean 'original'"),
    ),
    "lengths of cohesion": (
        {"density = 2": "cohesion = { core = 0.6 }"},
        ("flock.cohesion.attraction = 0.8", "core < equilibrium"),
    ),
    "cohesion beyond sight": (
        {"density = 2": "radius = 0.7\ncohesion = { strength = 1 }"},
        ("flock.cohesion.attraction = 0.8", "flock.radius = 0.7"),
    ),
    "cohesion of no strength": (
        {"density = 2": "cohesion = { strength = 0 }"},
        ("flock.cohesion.strength = 0", "above 0"),
    ),
    "shear": (
        {"size = [12, 12]": "size = [12, 12]\nshear_rate = 0.1"},
        ("box.shear_rate = 0.1: not with method 'flock'",),
    ),
    "open box": ({"size = [12, 12]": 'size = [12, 12]\nopen = ["x"]'}, ("box.open", "'flock'")),
    "walls in a box of halves": (
        {"[12, 12]": "[12.5, 12]", "": WALL},
        ("box.size = [12.5, 12]", "whole numbers"),
    ),
    "warm wall": (
        {"": WALL + 'surface = { rule = "diffuse" }'},
        ("wall[#1].surface.rule = 'diffuse'", "'slip'"),
    ),
    "turning wall": (
        {"": WALL + "surface = { rotation = 1 }"},
        ("wall[#1].surface.rotation", "not with method 'flock'"),
    ),
    "moving plate": (
        {"": PLATES + "lower = { velocity = [1, 0] }"},
        ("wall[#1].lower.velocity", "not with method 'flock'"),
    ),
    "plate that moves in 3D": (
        {"": PLATES + "lower = { velocity = [1, 0, 0] }"},
        ("wall[#1].lower.velocity = [1, 0, 0]: not with method 'flock'",),
    ),
    "contact of a wall": (
        {"": WALL + "surface = { contact = { friction = 1 } }"},
        ("wall[#1].surface.contact", "not with method 'flock'"),
    ),
    "sphere in 2D": (
        {"": WALL.replace("disk", "sphere").replace("[6, 6]", "[6, 6, 6]")},
        ("wall[#1]", "2D"),
    ),
    "plates twice": ({"": PLATES + PLATES}, ("wall[#2].axis = 'y'", "closes it already")),
    "plates across z": ({"": PLATES.replace('"y"', '"z"')}, ("'z'", "2D")),
    "wall beyond the box": ({"": WALL.replace("radius = 2", "radius = 40")}, ("wall", "0 cells")),
    "filler of a wall": (
        {"": WALL + 'virtual = "none"'},
        ("wall[#1].virtual = 'none'", "leave it out"),
    ),
    "unknown start": (
        {"density = 2": 'start = { headings = "all" }'},
        ("flock.start.headings = 'all'", "'aligned'"),
    ),
    "unknown quantity": (
        {"": '[[observe]]\nquantity = "order"'},
        ("observe[#1].quantity = 'order'",),
    ),
    "quantity of a fluid": (
        {"": '[[observe]]\nquantity = "stress"'},
        ("method 'flock' does not offer",),
    ),
    "molecules": (
        {"": '[[observe]]\nquantity = "mean-square-displacement"\nof = "centres"'},
        ("of = 'centres'", "'particles'"),
    ),
    "kinds": (
        {"": '[[observe]]\nquantity = "mean-square-displacement"\nkind = 1'},
        ("kind = 1", "leave it out"),
    ),
    "squares larger than the box": (
        {"": '[[observe]]\nquantity = "number-fluctuations"\nsides = [1, 13]'},
        ("sides = [1.0, 13.0]", "to 12"),
    ),
    "squares among walls": (
        {"": WALL + '[[observe]]\nquantity = "number-fluctuations"'},
        ("not among walls",),
    ),
    "bands in an oblong": (
        {"[12, 12]": "[24, 12]", "": '[[observe]]\nquantity = "density-bands"'},
        ("axis: missing", "[24, 12]"),
    ),
    "bands along z": (
        {"": '[[observe]]\nquantity = "density-bands"\naxis = "z"'},
        ("axis = 'z'", "2D"),
    ),
    "far clusters": (
        {"": '[[observe]]\nquantity = "cluster-sizes"\ndistance = 6'},
        ("distance = 6", "half of the box"),
    ),
    "spins": ({"": '[trajectory]\nevery = 1\nfields = ["spin"]'}, ("trajectory.fields", "'spin'")),
    "column of the log": (
        {"": '[log]\nevery = 1\ncolumns = ["odrer"]'},
        ("log.columns", "did you mean 'order'"),
    ),
    "units": ({"": '[units]\ncell = 1e-6\nmatch = "thermal"'}, ("units: method 'flock'",)),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_cases_get_one_line(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    changes, words = WRONG[name]
    file = tmp_path / "case.toml"
    file.write_text(changed(GOOD, changes))
    has_words(refused(capsys, "check", file), words)


def test_more_than_the_memory_is_refused_where_a_run_begins():
    """And not where a case is read: it may be one for a larger machine."""
    case = Case(
        run=Run(1, method="flock"), box=Box([30000, 30000]), flock=Flock(number=2_000_000_000)
    )
    with pytest.raises(
        CaseError, match=r"flock\.number = 2000000000: needs 320 GB of memory, this machine has"
    ):
        Simulation(case)


N = 6
RIGHT = np.ones((N, 2))
ARRAYS = {
    "rows": ({"positions": np.ones((5, 2))}, "positions: shape (5, 2): expected (6, 2)"),
    "text": ({"positions": [["a", "b"]] * N}, "positions: expected an array of numbers"),
    "ragged": ({"positions": [[1], [1, 2]]}, "positions: expected an array of numbers"),
    "not finite": ({"positions": np.full((N, 2), np.nan)}, "positions: row 0 is not finite"),
    "far": ({"positions": np.full((N, 2), 1e12)}, "positions: row 0"),
    "no direction": ({"velocities": np.zeros((N, 2))}, "velocities: row 0 = [0.0, 0.0] has no"),
    "other name": ({"beads": RIGHT}, "beads"),
}


@pytest.mark.parametrize("name", ARRAYS)
def test_wrong_arrays_get_one_line(name: str) -> None:
    given, words = ARRAYS[name]
    with pytest.raises(CaseError) as error:
        Simulation(
            Case(run=Run(1, method="flock"), box=Box([9, 9]), flock=Flock(number=N)), **given
        )
    assert words in str(error.value)
    assert "\n" not in str(error.value)


STARTS = {
    "no such file": ({"positions": "a.npy"}, "flock.start.positions = '", "no such file"),
    "no array": ({"positions": "case.toml"}, "expected a .npy or .npz file"),
    "no such run": ({"run": "b"}, "flock.start.run"),
    "no such particles": ({"file": "c.gsd"}, "flock.start.file"),
    "a run and positions": (
        {"run": ".", "positions": "case.toml"},
        "not with flock.start.run",
    ),
    "headings twice": (
        {"velocities": "v.npy", "headings": "aligned"},
        "headings: not with velocities",
    ),
}


@pytest.mark.parametrize("name", STARTS)
def test_wrong_starts_get_one_line(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given, *words = STARTS[name]
    np.save(tmp_path / "v.npy", np.ones((288, 2)))
    start = ", ".join(f'{key} = "{value}"' for key, value in given.items())
    file = tmp_path / "case.toml"
    file.write_text(GOOD + f"start = {{ {start} }}\n")
    has_words(refused(capsys, "check", file), words)
