"""Wrong cases of kinetic Monte Carlo: each is refused with one line that names the key."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mesokit import CaseError, Simulation
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.table import Process, rates_of
from mesokit.seam.method import summary_of
from tests.helpers.lattices import lattice_case
from tests.helpers.refusals import changed, has_words, refused

GOOD = """
[run]
steps = 10
method = "kinetic-monte-carlo"
[box]
size = [12, 10]
[lattice]
kind = "square"
timestep = 0.5
start = { rule = "random" }
[lattice.model]
rule = "ising"
kT = 2.0
[[observe]]
quantity = "magnetisation"
"""
GAS = """
[run]
steps = 10
method = "kinetic-monte-carlo"
[box]
size = [12, 10]
[lattice]
start = { rule = "uniform" }
[lattice.model]
rule = "lattice-gas"
species = ["empty", "A"]
[[lattice.model.process]]
name = "on"
site = "empty -> A"
rate = 1.0
[[lattice.model.process]]
name = "hop"
site = "A -> empty"
neighbour = "empty -> A"
rate = 1.0
bond = 0.5
bonded = ["A"]
"""
RANDOM = '{ rule = "random" }'
ISING = 'rule = "ising"\nkT = 2.0'
# name: (what is replaced by what in the good case, what the message must say)
BAD: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    "misspelt method": ({'"kinetic-monte-carlo"': '"kinetic-montecarlo"'}, ("run.method",)),
    "section of another method": ({"[lattice.model]": "[fluid]\n[lattice.model]"}, ("fluid",)),
    "misspelt choice": (
        {'kind = "square"': 'select = "class"'},
        ("lattice.select", "'class'", "'classes'"),
    ),
    "attempts in sublattices": (
        {
            'kind = "square"': 'select = "attempts"\nsublattices = { block = 32 }',
            "size = [12, 10]": "size = [64, 64]",
        },
        ("lattice.select", "'attempts'", "lattice.sublattices"),
    ),
    "block of no tiles": (
        {'kind = "square"': "sublattices = { block = 20 }", "size = [12, 10]": "size = [40, 40]"},
        ("lattice.sublattices.block = 20", "multiple of 32"),
    ),
    "lattice of no blocks": (
        {'kind = "square"': "sublattices = { block = 32 }"},
        ("box.size = [12, 10]", "multiples of lattice.sublattices.block = 32"),
    ),
    "negative cycle": (
        {'kind = "square"': "sublattices = { cycle = -1.0 }"},
        ("lattice.sublattices.cycle = -1", "above 0"),
    ),
    "misspelt moves": (
        {"kT = 2.0": 'kT = 2.0\nmoves = "swap"'},
        ("lattice.model.moves", "'swap'", "'exchange'"),
    ),
    "misspelt key": ({"timestep": "time_step"}, ("lattice.time_step", "'timestep'")),
    "misspelt kind": ({'"square"': '"squared"'}, ("lattice.kind", "'square'")),
    "no time": ({"timestep = 0.5": "timestep = 0"}, ("lattice.timestep = 0", "above 0")),
    "three axes": ({"[12, 10]": "[12, 10, 4]"}, ("box.size", "two numbers", "square")),
    "one axis": ({"[12, 10]": "[12]"}, ("box.size", "two numbers")),
    "a chain in a plane": ({'"square"': '"chain"'}, ("box.size", "one number", "chain")),
    "parts of a site": ({"[12, 10]": "[12.5, 10]"}, ("box.size", "whole numbers")),
    "one row": ({"[12, 10]": "[12, 1]"}, ("box.size", "at least 2")),
    "odd rows": ({"[12, 10]": "[12, 9]", '"square"': '"triangular"'}, ("box.size", "even", "y")),
    "odd bricks": ({"[12, 10]": "[11, 10]", '"square"': '"honeycomb"'}, ("box.size", "even", "x")),
    "no such axis": ({"timestep": 'ends = ["z"]\ntimestep'}, ("lattice.ends", "x")),
    "sheared": ({"[12, 10]": "[12, 10]\nshear_rate = 1"}, ("box.shear_rate",)),
    "misspelt model": ({'"ising"': '"izing"'}, ("lattice.model.rule", "'ising'")),
    "key of another model": ({"kT = 2.0": "flux = 2.0"}, ("lattice.model.flux", "unknown")),
    "cold": ({"kT = 2.0": "kT = -1"}, ("lattice.model.kT = -1",)),
    "misspelt dynamics": ({"kT = 2.0": 'dynamics = "heat"'}, ("lattice.model.dynamics",)),
    "nothing is tried": ({"kT = 2.0": "attempt_rate = 0"}, ("attempt_rate = 0", "above 0")),
    "misspelt start": ({RANDOM: '{ rule = "randm" }'}, ("lattice.start.rule", "'random'")),
    "no such state": ({RANDOM: '{ rule = "uniform", state = "left" }'},
                      ("lattice.start.state", "'up'")),
    "parts that are too much": ({RANDOM: '{ rule = "random", fractions = [0.5, 0.6] }'},
                                ("lattice.start", "sum 1")),
    "parts of too many": ({RANDOM: '{ rule = "random", fractions = [0.5, 0.25, 0.25] }'},
                          ("lattice.start.fractions", "2 numbers")),
    "a slab across z": ({RANDOM: '{ rule = "slab", axis = "z" }'}, ("lattice.start.axis", "2D")),
    "a droplet of nothing": ({RANDOM: '{ rule = "droplet", radius = 0 }'}, ("radius = 0",)),
    "no file": ({RANDOM: '{ rule = "file", file = "none.npy" }'}, ("lattice.start.file",)),
    "no run": ({RANDOM: '{ rule = "run", run = "none" }'}, ("lattice.start.run",)),
    "turns on a triangle": ({RANDOM: '{ rule = "alternating" }', '"square"': '"triangular"'},
                            ("'alternating'",)),
    "odd turns": ({RANDOM: '{ rule = "alternating" }', "[12, 10]": "[11, 10]"}, ("even", "x")),
    "velocities": ({"[[observe]]": '[trajectory]\nevery = 1\nfields = ["velocity"]\n[[observe]]'},
                   ("trajectory.fields", "'site'")),
    "no frame in a decade": (
        {"[[observe]]": '[trajectory]\nevery = 1\nfields = ["site"]\nper_decade = 0\n[[observe]]'},
        ("trajectory.per_decade = 0", "at least 1"),
    ),
    "part of the sites": (
        {"[[observe]]": '[trajectory]\nevery = 1\nfields = ["site"]\nsubset = 5\n[[observe]]'},
        ("trajectory.subset = 5", "written whole"),
    ),
    "order of heights": (
        {
            'rule = "ising"': 'rule = "rsos"',
            "kT = 2.0\n": "",
            '"magnetisation"': '"order-parameter"',
            'start = { rule = "random" }': "",
        },
        ("observe[#1]", "'rsos' has no states"),
    ),
    "heights of spins": ({'"magnetisation"': '"roughness"'}, ("observe[#1]", "no heights")),
    "correlation along no axis": ({'"magnetisation"': '"site-correlation"\ndirection = "z"'},
                                 ("observe[#1].direction", "2D")),
    "correlation along nonsense": ({'"magnetisation"': '"site-correlation"\ndirection = "r"'},
                                   ("observe[#1].direction", "'radius'")),
    "correlation of no state": ({'"magnetisation"': '"site-correlation"\nstate = "left"'},
                                ("observe[#1]", "state = 'left'", "'up'")),
    "waves of no state": ({'"magnetisation"': '"site-structure-factor"\nstate = "upp"'},
                          ("observe[#1]", "state = 'upp'", "'up'")),
    "waves of heights by name": ({'"magnetisation"': '"site-structure-factor"\nstate = "up"',
                                  'rule = "ising"\nkT = 2.0': 'rule = "family"',
                                  RANDOM: '{ rule = "uniform" }'},
                                 ("observe[#1]", "state = 'up'", "no names")),
    "domains of few sites": ({'"magnetisation"': '"domain-length"'},
                             ("observe[#1]", "box.size", "16")),
    "domains of heights": ({'"magnetisation"': '"domain-length"', RANDOM: '{ rule = "uniform" }',
                            'rule = "ising"\nkT = 2.0': 'rule = "family"'},
                           ("observe[#1]", "heights", "'roughness'")),
    "waves that are too long": ({'"magnetisation"': '"domain-length"\nlargest = 0.01',
                                 "[12, 10]": "[32, 10]"}, ("observe[#1].largest = 0.01",)),
    "walls below none": ({'"magnetisation"': '"domain-length"\nwalls = -1'},
                         ("observe[#1].walls = -1",)),
    "islands of no state": ({'"magnetisation"': '"islands"\nstate = "u"', "[12, 10]": "[32, 10]"},
                            ("observe[#1].state = 'u'", "'up'")),
    "islands of a level of spins": ({'"magnetisation"': '"islands"\nlevel = 1',
                                     "[12, 10]": "[32, 10]"}, ("observe[#1].level = 1", "heights")),
    "islands of nothing": ({'"magnetisation"': '"islands"\nsmallest = 0'},
                           ("observe[#1].smallest = 0",)),
    "islands of few sites": ({'"magnetisation"': '"island-sizes"'}, ("observe[#1]", "box.size")),
    "sizes at a level of spins": ({'"magnetisation"': '"island-sizes"\nlevel = 1',
                                   "[12, 10]": "[32, 10]"}, ("observe[#1].level = 1", "heights")),
    "differences of spins": ({'"magnetisation"': '"height-differences"'},
                             ("observe[#1]", "no heights")),
    "differences along no axis": ({'"magnetisation"': '"height-differences"\naxis = "z"',
                                   'rule = "ising"\nkT = 2.0': 'rule = "family"',
                                   RANDOM: '{ rule = "uniform" }'},
                                  ("observe[#1]", "axis = 'z'", "2D")),
    "steps of spins": ({'"magnetisation"': '"height-steps"'}, ("observe[#1]", "no heights")),
    "current of spins": ({'"magnetisation"': '"current"'}, ("observe[#1]", "to a neighbour")),
    "current of heights": ({'"magnetisation"': '"current"', RANDOM: '{ rule = "uniform" }',
                            'rule = "ising"\nkT = 2.0': 'rule = "family"'},
                           ("observe[#1]", "no particles")),
    "tracers of flips": ({'"magnetisation"': '"tracer-displacement"'},
                         ("observe[#1]", "'ising'", "nothing moves 'up'")),
    "tracers of no state": ({'"magnetisation"': '"tracer-displacement"\nstate = "upp"'},
                            ("observe[#1]", "state = 'upp'", "'up'")),
    "tracers of heights": ({ISING: 'rule = "family"', RANDOM: '{ rule = "uniform" }',
                            '"magnetisation"': '"tracer-displacement"'},
                           ("observe[#1]", "'family'", "heights")),
    "hops to both sides": ({'"magnetisation"': '"tracer-displacement"', "[12, 10]": "[12, 2]",
                            "kT = 2.0": 'kT = 2.0\nmoves = "exchange"'},
                           ("observe[#1]", "box.size = [12, 2]", "at least 3", "along y")),
    "no tracer": ({'"magnetisation"': '"tracer-displacement"\nparticles = 0'},
                  ("observe[#1].particles = 0",)),
    "no lag": ({'"magnetisation"': '"tracer-displacement"\nmax_lag = 0'},
               ("observe[#1].max_lag = 0",)),
    "stays in no state": ({'"magnetisation"': '"waiting-times"\nstate = "left"'},
                          ("observe[#1]", "state = 'left'", "'up'")),
    "stays at heights": ({ISING: 'rule = "family"', RANDOM: '{ rule = "uniform" }',
                          '"magnetisation"': '"waiting-times"'},
                         ("observe[#1]", "'family'", "heights")),
    "stays in sublattices": (
        {'"magnetisation"': '"waiting-times"', "size = [12, 10]": "size = [64, 64]",
         'kind = "square"': "sublattices = { block = 32 }"},
        ("observe[#1]", "lattice.sublattices", "'waiting-times'"),
    ),
    "an observable of fluids": ({'"magnetisation"': '"flow-rate"'},
                                ("observe[#1].quantity", "does not offer it")),
    "spins of a gas": ({'rule = "ising"\nkT = 2.0': 'rule = "potts"'},
                       ("observe[#1]", "spins")),
    "enters a ring": ({'"square"': '"chain"', "[12, 10]": "[12]",
                       'rule = "ising"\nkT = 2.0': 'rule = "exclusion"\nenter = 1.0'},
                      ("lattice.model.enter = 1", "lattice.ends")),
    "traffic in a plane": ({'rule = "ising"\nkT = 2.0': 'rule = "exclusion"'},
                           ("lattice.kind = 'square'", "'chain'")),
    "single steps of a flat start": ({'rule = "ising"\nkT = 2.0': 'rule = "single-step"',
                                      RANDOM: '{ rule = "uniform" }'},
                                     ("lattice.start", "'alternating'")),
    "barrier of what leaves": ({'rule = "ising"\nkT = 2.0':
                                'rule = "solid-on-solid"\nevaporate = true\nstep_barrier = 1.0'},
                               ("lattice.model", "step_barrier = 1")),
    "a surface that rests": ({'rule = "ising"\nkT = 2.0': 'rule = "single-step"\nup = 0',
                              RANDOM: '{ rule = "alternating" }'},
                             ("lattice.model", "all rates are 0")),
    "adatoms that hop back in time": ({ISING: 'rule = "surface-diffusion"\nattempt_rate = -1'},
                                      ("lattice.model.attempt_rate = -1",)),
    "adatoms in a well": ({ISING: 'rule = "surface-diffusion"\nsubstrate_energy = -1'},
                          ("lattice.model.substrate_energy = -1",)),
    "flux to the gas": ({ISING: 'rule = "surface-diffusion"\nflux = -1'},
                        ("lattice.model.flux = -1",)),
    "adatoms that leave back": ({ISING: 'rule = "surface-diffusion"\ndesorption_rate = -1'},
                                ("lattice.model.desorption_rate = -1",)),
    "adatoms without heat": ({ISING: 'rule = "surface-diffusion"\nkT = 0'},
                             ("lattice.model.kT = 0", "above 0")),
    "bonds that drive": ({ISING: 'rule = "islands"\nbond_factor = 1.5'},
                         ("lattice.model.bond_factor = 1.5",)),
    "atoms that rest": ({ISING: 'rule = "islands"\nhop_rate = 0'},
                        ("lattice.model.hop_rate = 0", "above 0")),
    "another version": ({ISING: 'rule = "eden"\nversion = "D"'},
                        ("lattice.model.version = 'D'", "'A'")),
    "a cluster that rests": ({ISING: 'rule = "eden"\ngrowth_rate = 0'},
                             ("lattice.model.growth_rate = 0", "above 0")),
    "walkers that rest": ({ISING: 'rule = "aggregation"\nhop_rate = 0'},
                          ("lattice.model.hop_rate = 0", "above 0")),
    "walkers that never stick": ({ISING: 'rule = "aggregation"\nsticking = 0'},
                                 ("lattice.model.sticking = 0", "above 0")),
    "walkers that stick twice": ({ISING: 'rule = "aggregation"\nsticking = 2'},
                                 ("lattice.model.sticking = 2",)),
    "a reservoir of no end": ({ISING: 'rule = "aggregation"\nreservoir = 0.5'},
                              ("lattice.model.reservoir = 0.5", "lattice.ends")),
    "a reservoir that is too full": ({ISING: 'rule = "aggregation"\nreservoir = 1.5'},
                                     ("lattice.model.reservoir = 1.5",)),
    "grains that repel": ({ISING: 'rule = "sintering"\nbond_energy = -1'},
                          ("lattice.model.bond_energy = -1",)),
    "grains without heat": ({ISING: 'rule = "sintering"\nkT = 0'},
                            ("lattice.model.kT = 0", "above 0")),
    "grains too large": ({RANDOM: '{ rule = "grains", radius = 4 }'},
                         ("lattice.start.radius = 4", "[16, 8]", "box.size")),
    "grains of no site": ({RANDOM: '{ rule = "grains", radius = 0.5 }'},
                          ("lattice.start.radius = 0.5",)),
    "grains along z": ({RANDOM: '{ rule = "grains", radius = 2, axis = "z" }'},
                       ("lattice.start.axis", "2D")),
    "a nucleus of no state": ({RANDOM: '{ rule = "nucleus", state = "left" }'},
                              ("lattice.start.state", "'up'")),
    "a nucleus across z": ({RANDOM: '{ rule = "nucleus", axis = "z" }'},
                           ("lattice.start.axis", "2D")),
    "a nucleus among too many": ({RANDOM: '{ rule = "nucleus", fractions = [1] }'},
                                 ("lattice.start.fractions", "2 numbers")),
    "a nucleus among too much": ({RANDOM: '{ rule = "nucleus", fractions = [1, 1] }'},
                                 ("fractions = [1, 1]", "sum 1")),
    "a nucleus of heights": ({ISING: 'rule = "rsos"', '"magnetisation"': '"event-rates"',
                              RANDOM: '{ rule = "nucleus" }'},
                             ("lattice.start.rule = 'nucleus'", "'terrace'")),
    "terraces of spins": ({RANDOM: '{ rule = "terrace" }'},
                          ("lattice.start.rule = 'terrace'", "'slab'")),
    "a terrace of no height": ({RANDOM: '{ rule = "terrace", height = 0 }'},
                               ("lattice.start", "height = 0")),
    "a terrace without a step": ({RANDOM: '{ rule = "terrace", part = 1 }'},
                                 ("lattice.start", "part = 1")),
    "a terrace across z": ({ISING: 'rule = "rsos"', '"magnetisation"': '"event-rates"',
                            RANDOM: '{ rule = "terrace", axis = "z" }'},
                           ("lattice.start.axis", "2D")),
    "single steps of terraces": ({ISING: 'rule = "single-step"', RANDOM: '{ rule = "terrace" }'},
                                 ("lattice.start", "'alternating'")),
    "units": ({"[[observe]]": '[units]\nlength = "1 nm"\n[[observe]]'}, ("units",)),
    "a column that is not": ({"[[observe]]": '[log]\nevery = 1\ncolumns = ["left"]\n[[observe]]'},
                             ("log.columns", "'up'")),
}  # fmt: skip
BAD_GAS: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {
    "unknown species": ({"empty -> A": "empty -> B"}, ("process[#1].site", "'A'")),
    "no arrow": ({'site = "A -> empty"': 'site = "A"'}, ("process[#2].site", "before -> after")),
    "one name twice": ({'"hop"': '"on"'}, ("process[#2].name", "of its own")),
    "one species": ({'["empty", "A"]': '["A", "A"]'}, ("species", "different")),
    "nothing happens": ({"rate = 1.0": "rate = 0.0"}, ("lattice.model", "all rates are 0")),
    "negative": ({"rate = 1.0": "rate = -1.0"}, ("rate = -1",)),
    "a turn that is none": ({'site = "A -> empty"\nneighbour = "empty -> A"': 'site = "A -> A"'},
                            ("process[#2].site", "changes nothing")),
    "outside is filled": ({'neighbour = "empty -> A"': 'neighbour = "outside -> A"'},
                          ("process[#2].neighbour", "outside")),
    "outside of no end": ({'neighbour = "empty -> A"': 'neighbour = "outside -> outside"'},
                          ("process[#2].neighbour", "lattice.ends")),
    "bonds to nothing": ({'bonded = ["A"]': ""}, ("process[#2].bond", "bonded")),
    "bonds to none": ({'bonded = ["A"]': 'bonded = ["B"]'}, ("process[#2].bonded", "'A'")),
    "current along no axis": ({"[lattice.model]":
                               '[[observe]]\nquantity = "current"\naxis = "z"\n[lattice.model]'},
                              ("observe[#1]", "axis = 'z'", "2D")),
    "current of no species": ({"[lattice.model]":
                               '[[observe]]\nquantity = "current"\nstate = "B"\n[lattice.model]'},
                              ("observe[#1].state = 'B'", "'A'")),
    "crossings on a ring": ({"[lattice.model]":
                             '[[observe]]\nquantity = "crossings"\n[lattice.model]'},
                            ("observe[#1].axis = 'x'", "lattice.ends")),
    "crossings of what lands": ({"[lattice.model]":
                                 '[[observe]]\nquantity = "crossings"\n[lattice.model]',
                                 "[lattice]": '[lattice]\nends = ["x"]'},
                                ("make particles",)),
    "a plane beyond the box": ({"[lattice.model]":
                                '[[observe]]\nquantity = "crossings"\npart = 1.5\n[lattice.model]'},
                               ("observe[#1].part = 1.5",)),
    "tracers that rest": ({"[lattice.model]":
                           '[[observe]]\nquantity = "tracer-displacement"\n[lattice.model]',
                           'neighbour = "empty -> A"': 'neighbour = "empty -> empty"'},
                          ("observe[#1]", "nothing moves 'A'")),
    "energy of a gas": ({"[lattice.model]":
                         '[[observe]]\nquantity = "lattice-energy"\n[lattice.model]'},
                        ("observe[#1]", "no energy")),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_wrong_cases_are_refused(name, capsys, tmp_path: Path):
    changes, words = BAD[name]
    case = tmp_path / "case.toml"
    case.write_text(changed(GOOD, changes))
    has_words(refused(capsys, "check", case), words)


@pytest.mark.parametrize("name", BAD_GAS)
def test_wrong_gases_are_refused(name, capsys, tmp_path: Path):
    changes, words = BAD_GAS[name]
    case = tmp_path / "case.toml"
    case.write_text(changed(GAS, changes))
    has_words(refused(capsys, "check", case), words)


@pytest.mark.parametrize("text", [GOOD, GAS])
def test_the_good_cases_are_good(text, tmp_path: Path):
    from mesokit import Case

    (tmp_path / "case.toml").write_text(text)
    assert Case.from_toml(tmp_path / "case.toml").particles == 120


@pytest.mark.parametrize(
    ("states", "words"),
    [
        (np.zeros(5, int), "shape"),
        (np.zeros((4, 4)), "whole numbers"),
        (np.full((4, 4), 2), "state 2: expected 0 to 1"),
        ("abc", "whole numbers"),
    ],
)
def test_wrong_arrays_are_refused(states, words):
    with pytest.raises(CaseError, match=words):
        Simulation(lattice_case((4, 4), Ising()), states=states)


def test_arrays_are_taken_by_number():
    states = np.arange(24).reshape(6, 4) % 2
    simulation = Simulation(lattice_case((6, 4), Ising()), states=states)
    np.testing.assert_array_equal(simulation.engine.sites(), states.ravel())
    heights = np.arange(24).reshape(6, 4) * 1000 - 500
    simulation = Simulation(lattice_case((6, 4), RestrictedSolidOnSolid()), states=heights)
    np.testing.assert_array_equal(simulation.engine.sites(), heights.ravel())


def raising(counts):
    raise ZeroDivisionError("no neighbours")


@pytest.mark.parametrize(
    ("process", "words"),
    [
        (Process("on", (0, 5), 1.0), r"states \[0, 5\] of 'on': expected numbers from 0 to 1"),
        (Process("hop", (1, 0), 1.0, neighbour=((3,), 1)), r"of neighbours of 'hop'"),
        (Process("on", (0, 1), -1.0), "rate of 'on' = -1.0: expected a finite number"),
        (Process("on", (0, 1), lambda counts: float("nan")), "rate of 'on' = nan"),
        (Process("on", (0, 1), raising), "rate of 'on': ZeroDivisionError: no neighbours"),
    ],
)
def test_wrong_processes_of_a_table_are_refused(process, words):
    with pytest.raises(CaseError, match=words):
        rates_of([process], 2, 2, KINDS["square"], False)


def test_a_barrier_far_below_the_state_has_no_rate(capsys, tmp_path: Path):
    case = tmp_path / "case.toml"
    case.write_text(
        changed(
            GAS,
            {
                "bond = 0.5": "barrier = -10.0\nbond = 0.5",
                "[lattice.model]": "[lattice.model]\nkT = 0.001",
            },
        )
    )
    has_words(refused(capsys, "check", case), ("rate of 'hop' = inf",))


def test_a_run_that_hardly_ends_is_warned_of():
    case = lattice_case((64, 64), Ising(), steps=10, timestep=1e300)
    warnings = " ".join(summary_of(case).warnings)
    assert "lattice.timestep: the run takes" in warnings
    usual = lattice_case((64, 64), Ising(kT=4.0), steps=10)
    assert "run takes" not in " ".join(summary_of(usual).warnings)
