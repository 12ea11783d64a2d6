"""Wrong wells and links of kinetic Monte Carlo: each is refused in a line that names the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit import Case
from tests.helpers.refusals import changed, has_words, refused

WELLS = """
[run]
steps = 10
method = "kinetic-monte-carlo"
[box]
size = [120]
[lattice]
kind = "chain"
[lattice.model]
rule = "wells"
kT = 0.5
well = [{ name = "left" }, { name = "right", energy = 1.0 }]
link = [{ hop = "left <-> right", barrier = 3.0 }]
[[observe]]
quantity = "coverage"
"""
OF_WELLS = 'well = [{ name = "left" }, { name = "right", energy = 1.0 }]\n'
OF_LINKS = 'link = [{ hop = "left <-> right", barrier = 3.0 }]\n'
BAD_WELLS: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    "one well": ({', { name = "right", energy = 1.0 }': ""}, ("lattice.model", "ring, not 1")),
    "no wells": ({OF_WELLS: "", OF_LINKS: ""}, ("lattice.model", "ring, not 0")),
    "one name twice": ({'name = "right"': 'name = "left"'}, ("well[#2].name", "of its own")),
    "unknown well": ({"<-> right": "<-> rigth"}, ("link[#1].hop", "'left' or 'right'")),
    "no arrow": ({"left <-> right": "left right"}, ("link[#1].hop", "well <-> well")),
    "to itself": ({"left <-> right": "left -> left"}, ("link[#1].hop", "different wells")),
    "no rate": ({", barrier = 3.0": ""}, ("link[#1]", "barrier or rate")),
    "two rates": ({"barrier = 3.0": "barrier = 3.0, rate = 1.0"}, ("barrier or rate",)),
    "no hops": ({"barrier = 3.0": "rate = 0.0"}, ("link[#1].rate = 0", "above 0")),
    "a barrier below": ({"barrier = 3.0": "barrier = 0.5"}, ("link[#1].barrier = 0.5", "at 1")),
    "a way twice": ({"3.0 }]": '3.0 }, { hop = "right -> left", rate = 1.0 }]'},
                    ("link[#2].hop", "a second way from 'right' to 'left'")),
    "no way": ({OF_LINKS: ""}, ("lattice.model", "all rates are 0")),
    "cold wells": ({"kT = 0.5": "kT = 0"}, ("lattice.model.kT = 0", "above 0")),
    "a ring of wells": ({OF_LINKS: "ring = { wells = 5, barrier = 2.0 }\n"},
                        ("lattice.model", "ring", "leave out well")),
    "a ring of two": ({OF_WELLS: "", OF_LINKS: "ring = { wells = 2, barrier = 2.0 }\n"},
                      ("ring.wells = 2", "at least 3")),
    "a steep ring": ({OF_WELLS: "", OF_LINKS: "ring = { wells = 5, barrier = 2.0, tilt = 5 }\n"},
                     ("ring", "tilt = 5", "twice the barrier of 2")),
    "too many wells": ({OF_WELLS: "", OF_LINKS: "ring = { wells = 201, barrier = 2.0 }\n"},
                       ("ring.wells = 201", "200")),
    "energy of rates": ({"barrier = 3.0": "rate = 3.0", '"coverage"': '"lattice-energy"'},
                        ("observe[#1]", "no energy")),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD_WELLS)
def test_wrong_wells_are_refused(name, capsys, tmp_path: Path):
    changes, words = BAD_WELLS[name]
    case = tmp_path / "case.toml"
    case.write_text(changed(WELLS, changes))
    has_words(refused(capsys, "check", case), words)


def test_the_good_case_is_good(tmp_path: Path):
    (tmp_path / "case.toml").write_text(WELLS)
    assert Case.from_toml(tmp_path / "case.toml").particles == 120
