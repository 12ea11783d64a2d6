"""Every quantity in every method: measured, or refused in a line that names the key."""

import dataclasses

import pytest

from mesokit import Case, CaseError
from mesokit.case.methods import templates
from mesokit.case.registry import family_of
from mesokit.seam.method import method_of

TEMPLATES = ["bulk", "poiseuille", "brownian", "flock", "event_driven", "soft_spheres"]


def quantities() -> list[str]:
    """Of all methods and packages."""
    return sorted(family_of(Case.from_toml(templates()["bulk"]).observe[0]).parts)


@pytest.mark.parametrize("name", TEMPLATES)
def test_it_is_measured_or_refused(name: str) -> None:
    case = Case.from_toml(templates()[name])
    said = {}
    for quantity in quantities():
        try:
            part = family_of(case.observe[0]).parts[quantity]()
            one = dataclasses.replace(case, observe=(part,))
            method_of(one).check(one)
            said[quantity] = "measured"
        except CaseError as error:
            said[quantity] = str(error)
    assert "measured" in said.values()
    refused = [text for text in said.values() if text != "measured"]
    assert refused and not [text for text in refused if "\n" in text]
    assert not [text for text in refused if not text.startswith(("observe[#1]", "fluid", "run"))]
