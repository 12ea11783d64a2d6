"""Whatever stands in a case, it is a valid case or one line that says what is wrong."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesokit import Case, CaseError
from mesokit.case.methods import templates
from mesokit.case.toml import parse
from mesokit.seam.method import method_of

TEMPLATES = [Path(str(path)) for path in templates().values()]


def paths(data: dict[str, Any], start: str = "") -> list[str]:
    """Every key path of a case."""
    found = []
    for key, value in data.items():
        found.append(start + key)
        if isinstance(value, dict):
            found += paths(value, f"{start}{key}.")
        elif isinstance(value, list):
            for i, item in enumerate(value):
                found += paths(item, f"{start}{key}.{i + 1}.") if isinstance(item, dict) else []
    return found


PATHS = [(path, key) for path in TEMPLATES for key in paths(tomllib.loads(path.read_text()))]
scalars = st.one_of(
    st.booleans(), st.integers(), st.floats(), st.text(max_size=9), st.just(10**400), st.dates(),
    st.sampled_from(["srd", "at", "none", "uniform", "slip", "x", "y", "z"]),
)  # fmt: skip
keys = st.one_of(st.text(max_size=9), st.sampled_from(["rule", "angle", "axis", "every"]))
values = st.recursive(
    scalars, lambda v: st.lists(v, max_size=4) | st.dictionaries(keys, v, max_size=3)
)


@settings(max_examples=300)
@given(st.sampled_from(PATHS), st.sampled_from(["", ".extra"]), values)
def test_any_value_anywhere(place: tuple[Path, str], more: str, value: Any) -> None:
    path, key = place
    try:
        case = Case.from_toml(path, {key + more: value})
    except CaseError as error:
        assert len(str(error).splitlines()) == 1
        assert path.name in str(error)
    else:
        method_of(case).summary(case, 1)


@given(st.text())
def test_any_text(text: str) -> None:
    try:
        parse(text)
    except CaseError as error:
        assert len(str(error).splitlines()) == 1


@pytest.mark.parametrize("text", ["a = " + "[" * 100_000, "a = " + "{ a = " * 10_000])
def test_absurd_nesting(text: str) -> None:
    try:
        parse(text)
    except CaseError as error:
        assert "TOML" in str(error)
