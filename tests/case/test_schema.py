"""The JSON schema lets pass what cases say, and nothing misspelt; explanations come from it."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest

import mesokit
from mesokit import CaseError, component, param
from mesokit.case.describe import kept, keys
from mesokit.case.methods import METHODS, templates
from mesokit.case.registry import FAMILIES, address
from mesokit.cli import main
from mesokit.method.spheres.soft.pair import PairLaw

ROOT = Path(__file__).resolve().parents[2]
CASES = [Path(str(file)) for file in templates().values()]
CASES += sorted(
    path for path in (ROOT / "examples").rglob("*.toml") if path.parent.name != "studies"
)
GOOD = {"run": {"steps": 10}, "box": {"size": [10, 10]}}


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft7Validator:
    found = mesokit.schema()
    jsonschema.Draft7Validator.check_schema(found)
    return jsonschema.Draft7Validator(found)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.stem)
def test_templates_and_examples_pass(case: Path, validator: jsonschema.Draft7Validator) -> None:
    validator.validate(tomllib.loads(case.read_text(encoding="utf-8")))


@pytest.mark.parametrize(
    "wrong",
    [
        "[fluid]\ndensty = 10",
        "[fluid]\ndensity = '10'",
        "[fluid]\ndensity = 0",
        "[fluid]\ntimestep = 1e4",
        "[fluid]\ncollision = { angle = 130 }",
        "[fluid]\ncollision = { rule = 'srt' }",
        "[fluid]\ncollision = { rule = 'at', angle = 130 }",
        "[fluid]\nforce = { rule = 'uniform' }",
        "[[wall]]\nshape = 'disk'\ncentre = [5, 5]",
        "[[wall]]\nshape = 'disk'\ncentre = [5, 5]\nradius = true",
        "[[wall]]\nshape = 'array'\nrepeat = [2, 2]\nof = { shape = 'plates', axis = 'y' }",
        "[walls]",
        "[wall]\nshape = 'plates'\naxis = 'y'",
        "[[observe]]\nquantity = 'wakes'",
        "[[observe]]\nquantity = 'wake'\nevery = 0.5",
        "[units]\ncell = 1e-6\nmatch = 'reynolds'\nfluid = { temperature = 300 }",
        "[brownian]",
        "title = 3",
    ],
)
def test_what_is_wrong_does_not(wrong: str, validator: jsonschema.Draft7Validator) -> None:
    assert validator.is_valid(GOOD)
    assert not validator.is_valid(tomllib.loads(wrong) | GOOD)


def test_sections_are_those_of_the_method(validator: jsonschema.Draft7Validator) -> None:
    run = {"steps": 10, "method": "brownian"}
    assert validator.is_valid(GOOD | {"run": run, "brownian": {}})
    assert not validator.is_valid(GOOD | {"run": run, "fluid": {}})
    observe = [{"quantity": "stress"}]
    assert validator.is_valid(GOOD | {"observe": observe})
    assert not validator.is_valid(GOOD | {"run": run, "observe": observe})


def test_parts_from_outside_are_in_it() -> None:
    family = FAMILIES[mesokit.Force]

    @component
    class Gust(mesokit.Force):
        """Wind in gusts."""

        rule: str = mesokit.tag("gust")
        speed: float = param(1.0, doc="of the gust", unit="a/time", gt=0)

    try:
        found = mesokit.schema()
        (said,) = mesokit.explain("fluid.force.gust")
    finally:
        del family.parts["gust"]
    assert found["definitions"]["Gust"]["properties"]["speed"]["exclusiveMinimum"] == 0
    assert said.keys[-1].values == "number above 0 [a/time], default 1"


def test_the_only_part_need_not_be_named(validator: jsonschema.Draft7Validator) -> None:
    solutes = {
        "polymers": [{"length": 5}],
        "bond": {"rule": "fene"},
        "bending": {"kappa": 2},
    }
    assert validator.is_valid(GOOD | {"solutes": solutes})


@pytest.mark.parametrize(
    ("path", "where", "words"),
    [
        ("wall.disk", "wall.disk", "number above 0 [a], required"),
        ("wake", "observe.wake", "number above 0 [a], default 1"),
        ("srd", "fluid.collision.srd", "number above 0, at most 180 [degrees], default 130"),
        ("run.seed", "run.seed", "whole number at least 0, below 2^56, default 1"),
        ("fluid.force.sinusoidal", "fluid.force.sinusoidal", '"x", "y" or "z", default "y"'),
        ("wall.2.surface.rule", "wall.", '"no-slip", "slip" or "diffuse", default "no-slip"'),
        ("box", "box", "list of numbers [a], required"),
    ],
)
def test_explanations(path: str, where: str, words: str) -> None:
    found = mesokit.explain(path)[0]
    assert found.path.startswith(where)
    assert found.meaning
    assert words in [key.values for key in found.keys]


def test_every_key_of_a_case_has_a_meaning() -> None:
    found = mesokit.schema()
    for definition in [found, *found["definitions"].values()]:
        for name, key in definition["properties"].items():
            assert key["description"], (definition["title"], name)


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("wal", "did you mean 'wall'?"),
        ("wall.disc", "did you mean 'disk'?"),
        ("run.sed", "did you mean 'seed'?"),
        ("wakes", "did you mean 'wake'?"),
        ("run.seed.x", "run.seed has no keys inside"),
        ("wall.contact", "'wall.surface.contact', 'wall.lower.contact' or 'wall.upper.contact'?"),
    ],
)
def test_unknown_keys_are_refused(path: str, words: str) -> None:
    with pytest.raises(CaseError, match=words.replace("?", r"\?")):
        mesokit.explain(path)


def test_what_two_methods_take_is_told_once_where_it_is_the_same() -> None:
    (spheres,) = mesokit.explain("spheres")
    takes = {key.name: key.takes for key in spheres.keys}
    assert takes["timestep"] == "number above 0, at most 1000000000"
    assert takes["spin_kT"] == "number at least 0, at most 1000000000"
    options = [{"type": "number", "minimum": m, "title": f"method '{m}'"} for m in (0, 1)]
    assert keys.takes({"anyOf": options}, {}) == (
        "method '0': number at least 0; method '1': number at least 1"
    )


def test_help_shows_the_keys() -> None:
    text = mesokit.SRD.__doc__ or ""
    assert "angle (number above 0, at most 180 [degrees], default 130): rotation angle" in text
    assert text.startswith("Rotate relative velocities")
    assert mesokit.schema()["definitions"]["SRD"]["description"] in text
    assert ">>> " in (mesokit.Case.__doc__ or "")


def test_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def ends(*words: str) -> object:
        with pytest.raises(SystemExit) as end:
            main(words)
        return end.value.code

    file = tmp_path / "case.schema.json"
    assert ends("schema", "--output", str(file)) == 0
    assert json.loads(file.read_text(encoding="utf-8")) == mesokit.schema()
    capsys.readouterr()
    assert ends("explain", "wall.disk") == 0
    assert "radius" in capsys.readouterr().out
    assert ends("explain") == 0
    assert "observe" in capsys.readouterr().out
    assert ends("explain", "wall.disc") == 2


def test_a_new_case_names_the_schema_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit):
        main(["new", "bulk"])
    text = Path("bulk.toml").read_text(encoding="utf-8")
    named = text.splitlines()[0].removeprefix("#:schema ./")
    jsonschema.validate(tomllib.loads(text), json.loads(Path(named).read_text(encoding="utf-8")))


def test_a_key_of_a_section_is_found_by_its_name_alone() -> None:
    found, *damped = mesokit.explain("pulls")  # of beads, and of dashpots
    pairs = ["spheres.pair.hertz.pulls", "spheres.pair.spring-dashpot.pulls"]
    assert sorted(one.path for one in damped) == pairs
    assert found.path == "solutes.pulls"
    assert "bead" in {key.name for key in found.keys}
    assert mesokit.explain("open")[0].path == "box.open"
    assert mesokit.explain("wake")[0].path == "observe.wake"  # parts come first


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of its own, in a process whose parts are those of mesokit alone."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(kept, "_has_others", lambda: False)
    return tmp_path / "mesokit"


def test_the_schema_is_kept_until_a_source_changes(cache, monkeypatch):
    made = kept.kept_schema()
    assert made == mesokit.schema()
    (file,) = cache.iterdir()
    file.write_text('{"kept": true}')
    assert kept.kept_schema() == {"kept": True}
    file.write_text("{")
    assert kept.kept_schema() == made
    monkeypatch.setattr(kept, "_sources", lambda: ["changed.py 1 1"])
    assert kept.kept_schema() == made
    (other,) = cache.iterdir()
    assert other.name != file.name


def test_parts_from_elsewhere_are_in_the_schema(cache, monkeypatch, tmp_path):
    """A module that --import names brings one: nothing is kept."""
    monkeypatch.undo()
    (tmp_path / "wheels.py").write_text(
        "from typing import Literal\n"
        "from mesokit import component\n"
        "from mesokit.case.component import tag\n"
        "from mesokit.method.mpcd.collision.srd import SRD\n"
        "@component\n"
        "class Wheel(SRD):\n"
        '    """Turns."""\n'
        '    rule: Literal["wheel"] = tag("wheel")\n'
    )
    code = "from mesokit.cli import main; main()"
    ended = subprocess.run(
        [sys.executable, "-c", code, "--import", "wheels", "explain", "fluid.collision.wheel"],
        cwd=tmp_path, env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert "Turns." in ended.stdout
    assert not list(tmp_path.rglob("schema-*"))


def test_the_methods_are_named(capsys):
    with pytest.raises(SystemExit):
        main(["explain", "run.method"])
    said = " ".join(capsys.readouterr().out.split())
    assert all(f'"{name}"' in said for name in METHODS)
    assert 'default "mpcd"' in said


def test_pair_laws_are_in_one_order_whichever_was_imported_first():
    family = FAMILIES[PairLaw]

    def ours():  # other tests may have defined laws of their own
        return [name for name, part in family.parts.items() if address(part).startswith("mesokit.")]

    ordered = ours()
    assert ordered[:2] == ["hertz", "spring-dashpot"] and ordered[2:] == sorted(ordered[2:])
    kept = dict(family.known)
    try:
        family.known = {name: kept[name] for name in reversed(kept)}
        assert ours() == ordered
    finally:
        family.known = kept


@pytest.mark.parametrize(
    ("word", "paths"),
    [
        ("cohesion", ["flock.cohesion", "spheres.contact.cohesion"]),
        ("sweeps", ["spheres.solver.gauss-seidel.sweeps, spheres.solver.jacobi.sweeps"]),
        ("order", ["flock.order", "spheres.solver.gauss-seidel.order"]),
    ],
)
def test_keys_are_found_by_name_wherever_they_are(word, paths):
    assert sorted(found.path for found in mesokit.explain(word)) == paths


def test_keys_of_walls_are_found_by_name():
    (found,) = mesokit.explain("travel")
    assert found.path.startswith("wall.") and found.path.endswith("contact.travel")


def test_a_key_of_one_of_three_methods_names_it_once():
    (found,) = mesokit.explain("spheres.contact")
    assert found.meaning.startswith("method 'contact-dynamics': what two")
