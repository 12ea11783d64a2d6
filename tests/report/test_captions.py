"""Measured against expected in words: below figures, in tables and in plain lines."""

from __future__ import annotations

import io

import numpy as np
import pytest
from rich.console import Console

from mesokit import Comparison
from mesokit.observe import Result
from mesokit.report import print_comparisons
from mesokit.report.caption import MOST, compared, mathematics

COMPARED = Result(
    "stress", "mine", {}, np.array(0.88), np.array(0.01), "stress", {"value": ""},
    comparisons=(
        Comparison("viscosity", 0.88, 0.01, 0.87, "a^2/tau"),
        Comparison("drift", 0.0, 0.0, 0.0),
        Comparison("far off", 2.0, 0.1, 1.0),
    ),
)  # fmt: skip


def test_comparisons_are_plain_lines_in_a_file():
    out = io.StringIO()
    print_comparisons([COMPARED], Console(file=out, width=40))
    lines = out.getvalue().splitlines()
    assert lines[0] == (
        "mine: viscosity: 0.880(10) a^2/tau, expected 0.8700: +1.0 standard errors, +1.1 %"
    )
    assert lines[1] == "mine: drift: 0, expected 0"
    assert len(lines) == 3


def test_comparisons_are_a_table_on_a_terminal():
    out = io.StringIO()
    print_comparisons([COMPARED], Console(file=out, width=120, force_terminal=True))
    assert "measured" in out.getvalue() and "+1.0 s.e. (+1.1 %)" in out.getvalue()
    assert "\x1b[1;33m" in out.getvalue()  # the one that is far off stands out
    print_comparisons([], Console(file=out))


def test_captions_keep_cautions_and_say_them_once():
    lines = compared(
        [
            Comparison("viscosity", 1.0, 0.1, 0.9, "a^2/tau", "error bar is a lower bound: short"),
            Comparison("time 1", 9.0, 0.1, 10.0, "tau", "approximate: Rouse" + 20 * "!"),
            Comparison("time 2", 8.0, 0.1, 10.0, "tau", "approximate: Rouse" + 20 * "!"),
            Comparison("slope", 1.0, 0.1, 1.0, "", "independent of slip"),
        ],
        6.4,
    ).splitlines()
    assert lines[0].endswith("(theory 0.9, at most +1.0 s.e.; error bar is a lower bound: short)")
    assert lines[1].endswith("(theory 10, -10 %; approximate)") and "tau$" in lines[1]
    assert lines[3].endswith("+0.0 s.e.)") and lines[4] == "approximate: Rouse" + 20 * "!"


def test_captions_are_short_and_fit_the_figure():
    one = Comparison("drag coefficient", 1.0, 0.1, note="U = 0.5 a/tau, " + 20 * "long ")
    lines = compared([one], 6.4).splitlines()
    assert len(lines) == 2 and max(map(len, lines)) < 110 and r"$a/\tau$" in lines[0]
    many = [Comparison(f"share {i}", 1.0, 0.1) for i in range(MOST + 3)]
    assert compared(many, 6.4).splitlines()[-1] == "and 3 more, which mesokit info shows"


@pytest.mark.parametrize("text", ["velocity v_x", "N sqrt(m kT)", "exp(-t/tau_p)", "0.2(1) a/tau"])
def test_formulas_in_words_are_set_as_formulas(text):
    from matplotlib.mathtext import MathTextParser

    drawn = mathematics(text)
    assert drawn.count("$") == 2 and mathematics(drawn) == drawn
    MathTextParser("path").parse(drawn)
