"""Wrong observables of spheres and flocks: each is refused with one line that names the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit import Case
from mesokit.errors import CaseError
from tests.helpers.refusals import changed, has_words

BOX = "[box]\nsize = [20, 20]\n"
HARD = '[run]\nsteps = 10\nmethod = "event-driven"\n' + BOX + "[spheres]\nnumber = 30\n"
SOFT = HARD.replace("event-driven", "soft-spheres")
BIRDS = '[run]\nsteps = 10\nmethod = "flock"\n' + BOX + "[flock]\ndensity = 2\n"
FLUID = "[run]\nsteps = 10\n" + BOX
THREE = {"[20, 20]": "[20, 20, 20]"}
ONE, TWO, THREE_SPHERES = ({"number = 30": f"number = {n}"} for n in (1, 2, 3))
SPREAD = {"number = 30": "number = 30\nkinds = [{ spread = 0.1 }]"}
KINDS = {"number = 30": "number = 30\nkinds = [{ diameter = 1 }, { diameter = 2 }]"}
LOSSY = {"number = 30": 'number = 30\ncollision = { rule = "hard", restitution = 0.9 }'}
FALL = {"number = 30": "number = 30\ngravity = [0, -1]"}
ATOMS = {"number = 30": 'number = 30\npair = { rule = "wca" }'}
PLATES = '[[wall]]\nshape = "plates"\naxis = "{}"\n'
# (good case, what is replaced, walls, quantity, its keys, what the message must say)
BAD: list[tuple[str, dict[str, str], str, str, str, tuple[str, ...]]] = [
    *(
        (case, {}, "", quantity, "every = 0", ("observe[#1].every = 0", "at least 1"))
        for case, quantity in (
            (HARD, "collision-rate"),
            (HARD, "velocity-cumulant"),
            (SOFT, "contact-clusters"),
            (BIRDS, "polar-order"),
        )
    ),
    *(
        (case, {}, "", quantity, "evry = 2", ("observe[#1].evry", "'every'"))
        for case, quantity in (
            (HARD, "equation-of-state"),
            (SOFT, "hexatic-order"),
            (BIRDS, "density-bands"),
        )
    ),
    (HARD, {}, "", "collision-rat", "", ("quantity = 'collision-rat'", "'collision-rate'")),
    (SOFT, {}, "", "collision-rates", "", ("quantity", "'collision-rate'")),
    (BIRDS, {}, "", "polar-ordr", "", ("quantity", "'polar-order'")),
    (HARD, {}, "", "polar-order", "", ("observe[#1].quantity", "does not offer")),
    (SOFT, {}, "", "number-fluctuations", "", ("observe[#1].quantity", "does not offer")),
    (BIRDS, {}, "", "collision-rate", "", ("observe[#1].quantity", "does not offer")),
    (BIRDS, {}, "", "height-profile", "", ("observe[#1].quantity", "does not offer")),
    (HARD, {}, "", "cell-occupancy", "", ("does not offer", "'collision-rate'", "'wall-force'")),
    (SOFT, {}, "", "flow-rate", "", ("observe[#1].quantity", "does not offer")),
    (HARD, LOSSY, "", "equation-of-state", "", ("observe[#1]", "keep energy")),
    (HARD, {}, PLATES.format("y"), "equation-of-state", "", ("observe[#1]", "with walls")),
    (HARD, FALL, PLATES.format("y"), "equation-of-state", "", ("observe[#1]", "gravity")),
    (FLUID, {}, PLATES.format("x") + 'upper = { rule = "diffuse" }\n', "wall-stress", "",
     ("observe[#1] (wall-stress): wall[#1].upper.rule = 'diffuse'", "observe 'forces'")),
    (FLUID, {}, "", "wall-stress", "", ("observe[#1]", "one [[wall]] of shape 'plates'")),
    (HARD, {}, "", "wall-force", "", ("observe[#1]", "[[wall]]")),
    (HARD, {}, "", "contact-forces", "", ("observe[#1].quantity", "does not offer")),
    (HARD, {}, "", "contact-network", "", ("observe[#1].quantity", "does not offer")),
    (SOFT, ATOMS, "", "contact-forces", "", ("spheres.pair = { rule = 'wca' }", "law of contact")),
    (SOFT, ATOMS, "", "contact-network", "", ("spheres.pair = { rule = 'wca' }", "law of contact")),
    (SOFT, {}, "", "contact-forces", 'of = "friction"', ("of = 'friction'", "'normal'")),
    (SOFT, {}, "", "contact-forces", 'of = "tangential"', ("of = 'tangential'", "'friction'")),
    (SOFT, {}, "", "contact-forces", "bins = 2", ("bins = 2", "at least 4")),
    (SOFT, {}, "", "contact-forces", "largest = 0.5", ("largest = 0.5", "at least 1")),
    (SOFT, {}, "", "contact-forces", "least = -1", ("least = -1", "at least 0")),
    (SOFT, {}, "", "contact-network", "least = -1", ("least = -1", "at least 0")),
    (SOFT, {}, "", "contact-network", "bins = 9", ("observe[#1].bins", "unknown")),
    (SOFT, ONE, "", "contact-forces", "", ("observe[#1]", "1 sphere; expected 2")),
    (SOFT, {}, "", "contact-force", "", ("quantity = 'contact-force'", "'contact-forces'")),
    (HARD, {}, "", "height-profile", "", ("observe[#1]", "gravity along one axis")),
    (HARD, FALL, PLATES.format("y"), "height-profile", "bins = 1", ("bins = 1", "at least 2")),
    (SOFT, {}, PLATES.format("y"), "height-profile", "", ("observe[#1]", "gravity")),
    (HARD, THREE, "", "hexatic-order", "", ("observe[#1]", "2D")),
    (SOFT, THREE, "", "hexatic-order", "", ("observe[#1]", "2D")),
    (HARD, {}, PLATES.format("x"), "hexatic-order", "", ("observe[#1]", "with walls")),
    (HARD, THREE_SPHERES, "", "hexatic-order", "", ("observe[#1]", "3 disks", "4 at least")),
    (HARD, TWO, "", "velocity-cumulant", "", ("observe[#1]", "2 spheres", "3 at least")),
    (HARD, KINDS, "", "velocity-cumulant", "", ("observe[#1]", "one kind")),
    (SOFT, SPREAD, "", "velocity-cumulant", "", ("observe[#1]", "without spread")),
    (HARD, {}, "", "contact-clusters", "gap = 0", ("gap = 0", "above 0")),
    (SOFT, {}, "", "contact-clusters", "gap = -1", ("gap = -1", "above 0")),
    (SOFT, {}, "", "contact-clusters", 'gap = "wide"', ("gap", "a number")),
    (SOFT, {}, "", "contact-clusters", "distance = 1", ("distance", "unknown key")),
    (HARD, {}, "", "mean-square-displacement", "max_lag = 0", ("max_lag = 0", "at least 1")),
    (HARD, {}, "", "mean-square-displacement", 'components = ["z"]', ("components", "'z'")),
    (SOFT, {}, "", "mean-square-displacement", 'of = "beads"', ("of", "'particles'")),
    (HARD, KINDS, "", "radial-distribution", 'of = "big"', ("of = 'big'", "chosen by `kinds`")),
    (SOFT, {}, PLATES.format("x") + PLATES.format("y"), "mean-square-displacement", "",
     ("observe[#1]", "every axis is closed")),
    (HARD, {}, "", "packing-fraction", "region = [[0, 5]]",
     ("region = [[0, 5]]", "each of the 2 axes")),
    (SOFT, {}, "", "packing-fraction", "region = [[0, 5], [9, 4]]",
     ("region", "0 <= from < to <= 20 along y", "[9, 4]")),
    (SOFT, {}, "", "packing-fraction", 'axis = "z"', ("axis = 'z'", "x, y")),
    (HARD, {}, "", "packing-fraction", "interior = true", ("interior = true", "gravity")),
    (HARD, {}, "", "packing-fraction", "bins = 0", ("bins = 0", "at least 1")),
    (HARD, {}, "", "outflow", "at = 21", ("at = 21", "from 0 to 20")),
    (SOFT, {}, "", "outflow", 'axis = "z"', ("axis = 'z'", "x, y")),
    (SOFT, {}, "", "outflow", "window = [[0, 5], [0, 5]]", ("window", "along y")),
    (SOFT, {}, "", "outflow", "window = [[0, 25]]", ("window", "to <= 20 along y")),
    (SOFT, {}, "", "outflow", "width = 5", ("width = 5", "gravity along x")),
    (HARD, FALL, PLATES.format("y"), "outflow", "fraction = 0.7", ("fraction", "without width")),
    (HARD, FALL, PLATES.format("y"), "outflow", 'axis = "x"\nwidth = 4', ("width", "along x")),
    (HARD, FALL, PLATES.format("y"), "outflow", 'of = "grains"', ("of = 'grains'", "'number'")),
    (HARD, {}, "", "repose-angle", "", ("observe[#1]", "gravity along one axis")),
    (HARD, FALL, PLATES.format("y"), "repose-angle", 'axis = "y"', ("axis = 'y'", "horizontal")),
    (HARD, FALL, PLATES.format("y"), "repose-angle", 'shape = "cone"', ("shape", "'ridge'")),
    (HARD, FALL, PLATES.format("y"), "repose-angle", "cell = 0", ("cell = 0", "above 0")),
    (SOFT, {}, "", "run-out", "", ("observe[#1]", "gravity along one axis")),
    (HARD, FALL, PLATES.format("y"), "run-out", 'sides = "lower"', ("sides", "plates along x")),
    (HARD, FALL, PLATES.format("y"), "run-out", 'sides = "round"', ("sides", "three axes")),
    (HARD, FALL, PLATES.format("y"), "run-out", "gap = 0", ("gap = 0", "above 0")),
    (SOFT, {}, PLATES.format("y"), "wall-load", "", ("observe[#1]", "gravity along one axis")),
    (SOFT, FALL, PLATES.format("y"), "wall-load", 'floor = "roof"',
     ("floor = 'roof'", "plates-1-lower")),
    (SOFT, FALL, PLATES.format("y"), "wall-load", "friction = 0.5",
     ("friction = 0.5", "no walls beside those of y")),
    (SOFT, FALL, PLATES.format("y"), "wall-load", "width = 5", ("width", "without friction")),
    (HARD, {}, "", "shear-rheology", "", ("observe[#1]", "plates across the gradient")),
    (SOFT, {}, PLATES.format("y"), "shear-rheology", 'axis = "x"', ("observe[#1]", "plates")),
    (SOFT, {}, PLATES.format("y"), "shear-rheology", 'component = "y"', ("component", "another")),
    (SOFT, {}, PLATES.format("y"), "shear-rheology", "margin = 10", ("margin = 10", "half")),
    (SOFT, {}, PLATES.format("x") + PLATES.format("y"), "shear-rheology", "",
     ("axis", "x, y", "plates")),
    (BIRDS, {}, "", "packing-fraction", "", ("observe[#1].quantity", "does not offer")),
    (FLUID, {}, "", "energy-budget", "", ("observe[#1].quantity", "does not offer")),
    (HARD, {}, "", "free-times", "bins = 48", ("bins = 48", "power of two")),
    (HARD, {}, "", "free-times", "bins = 4", ("bins = 4", "at least 8")),
    (SOFT, {}, "", "free-times", "", ("observe[#1].quantity", "does not offer")),
    (SOFT, {}, "", "wall-force", "", ("observe[#1]", "[[wall]]")),
    (HARD, {}, "", "density-profile", 'axis = "z"', ("axis = 'z'",)),
    (HARD, KINDS, "", "density-profile", "kind = 3", ("kind = 3", "1 to 2")),
    (SOFT, {}, "", "density-profile", 'of = "beads"', ("of = 'beads'", "'particles'")),
    (SOFT, {}, "", "density-profile", "bins_per_cell = 0", ("bins_per_cell = 0", "at least 1")),
    (BIRDS, {}, "", "density-profile", "", ("observe[#1].quantity", "does not offer")),
    (HARD, {}, "", "velocity-profile", 'component = "z"', ("component = 'z'",)),
    (SOFT, KINDS, "", "velocity-profile", 'kind = "blue"', ("kind = 'blue'", "1 to 2")),
    (SOFT, {}, "", "temperature-profile", "kind = 0", ("kind = 0", "expected 1")),
    (HARD, TWO, "", "velocity-distribution", "", ("observe[#1]", "2 spheres", "3 at least")),
    (SOFT, {}, "", "velocity-distribution", "kind = 2", ("kind = 2", "expected 1")),
    (SOFT, {}, "", "velocity-distribution", "bins = 5", ("bins = 5", "at least 10")),
    (BIRDS, {}, "", "velocity-distribution", "", ("observe[#1].quantity", "does not offer")),
    (FLUID, {}, "", "velocity-profile", "kind = 1", ("kind = 1", "of spheres alone")),
    (FLUID, {}, "", "temperature-profile", "kind = 1", ("kind = 1", "of spheres alone")),
    (FLUID, {}, "", "velocity-distribution", "kind = 1", ("kind = 1", "of spheres alone")),
    (FLUID, {}, "", "free-times", "", ("observe[#1].quantity", "does not offer")),
    (FLUID, {}, "", "granular-temperature", "", ("observe[#1].quantity", "does not offer")),
    (BIRDS, {}, "", "mean-square-displacement", 'of = "centres"', ("of", "'particles'")),
    (BIRDS, {}, "", "mean-square-displacement", "particles = 0", ("particles = 0", "at least 1")),
    (BIRDS, {}, "", "number-fluctuations", "sides = []", ("sides",)),
    (BIRDS, {}, "", "number-fluctuations", "sides = [30]", ("sides", "30")),
    (BIRDS, {}, "", "number-fluctuations", "sides = [-1]", ("sides",)),
    (BIRDS, {}, PLATES.format("y"), "number-fluctuations", "", ("observe[#1]", "wall")),
    (BIRDS, {}, "", "density-bands", "bins = 3", ("bins = 3", "at least 4")),
    (BIRDS, {}, "", "density-bands", 'axis = "z"', ("axis = 'z'",)),
    (BIRDS, {}, PLATES.format("y"), "density-bands", 'axis = "y"', ("observe[#1]", "wall")),
    (BIRDS, {}, "", "cluster-sizes", "distance = 0", ("distance = 0", "above 0")),
    (BIRDS, {}, "", "cluster-sizes", "distance = 50", ("distance = 50",)),
    (BIRDS, {}, "", "cluster-sizes", "gap = 1", ("gap", "unknown key")),
]  # fmt: skip


@pytest.mark.parametrize(
    ("good", "changes", "walls", "quantity", "keys", "expected"),
    BAD,
    ids=[f"{'hard' if b[0] == HARD else 'soft' if b[0] == SOFT else 'others'}-{b[3]}-{k}"
         for k, b in enumerate(BAD)],
)  # fmt: skip
def test_a_wrong_observable_is_refused(
    good: str,
    changes: dict[str, str],
    walls: str,
    quantity: str,
    keys: str,
    expected: tuple[str, ...],
    tmp_path: Path,
) -> None:
    text = changed(good, changes)
    file = tmp_path / "bad.toml"
    file.write_text(text + walls)
    Case.from_toml(file)
    file.write_text(f'{text}{walls}[[observe]]\nquantity = "{quantity}"\n{keys}\n')
    with pytest.raises(CaseError) as refused:
        Case.from_toml(file)
    has_words(str(refused.value), expected)


@pytest.mark.parametrize("good", [HARD, SOFT, BIRDS])
def test_twice_the_same_name(good: str, tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    one = '[[observe]]\nquantity = "mean-square-displacement"\n'
    file.write_text(good + one + one)
    with pytest.raises(CaseError, match=r"observe\[#2\]\.name: .* observe\[#1\]"):
        Case.from_toml(file)


@pytest.mark.parametrize("good", [HARD, SOFT, BIRDS])
@pytest.mark.parametrize("given", ["5", "2.5", "true", "[1]", "{}", '"sumething"'])
def test_what_is_no_name_is_told_where_names_are(good: str, given: str, tmp_path: Path) -> None:
    """File, key, value and what was expected in a short line, and not all names of all methods."""
    file = tmp_path / "bad.toml"
    file.write_text(f"{good}[[observe]]\nquantity = {given}\n")
    with pytest.raises(CaseError) as refused:
        Case.from_toml(file)
    message = str(refused.value)
    assert message.startswith(f"{file}: observe[#1].quantity")
    assert "\n" not in message and len(message) < len(str(file)) + 150
    assert "names, which `mesokit explain observe` lists" in message
    shown = given.replace('"', "'")
    assert f"= {shown}: expected" in message
    assert ("a text in quotes" in message) == (given != '"sumething"')
