"""The record of a run tells with which sources it was made, and from what it started."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mesokit import Box, Case, Fluid, Run, Simulation
from mesokit.io import provenance as module
from mesokit.method.mpcd.start.section import Start

CASE = Case(run=Run(steps=3), box=Box([8, 8]), fluid=Fluid())


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package in a folder of its own, and what its record says now."""
    place = tmp_path / "project" / "src" / "mesokit"
    (place / "inner").mkdir(parents=True)
    (place / "__init__.py").write_bytes(b"x = 1\n")
    (place / "inner" / "part.py").write_bytes(b"y = 2\n")
    monkeypatch.setattr(module, "PACKAGE", place)
    return place


def test_any_change_of_any_source_shows(package: Path) -> None:
    now = module.sources.__wrapped__
    first = now()
    assert first == now()
    seen = {first["digest"]}
    (package / "__init__.py").write_bytes(b"x = 1\r\n")  # as git writes it on Windows
    assert now() == first
    (package / "inner" / "part.py").write_bytes(b"y = 3\n")
    seen.add(now()["digest"])
    (package / "inner" / "part.py").rename(package / "inner" / "other.py")
    seen.add(now()["digest"])
    assert len(seen) == 3


@pytest.mark.skipif(shutil.which("git") is None, reason="there is no git")
def test_a_clone_tells_its_commit(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now, root = module.sources.__wrapped__, package.parents[1]
    identity = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
    for words in (["init", "-q"], ["add", "-A"], [*identity, "commit", "-qm", "first"]):
        subprocess.run(["git", "-C", root, *words], check=True)
    head = subprocess.run(["git", "-C", root, "rev-parse", "HEAD"], capture_output=True, text=True)
    assert (now()["commit"], now()["changed"]) == (head.stdout.strip(), "false")
    (package / "__init__.py").write_bytes(b"x = 4\n")
    assert (now()["commit"], now()["changed"]) == (head.stdout.strip(), "true")
    monkeypatch.setenv("PATH", "")  # a clone without git
    assert now()["commit"] is None and len(now()["digest"]) == 64


def record(folder: Path) -> dict:
    return json.loads((folder / "provenance.json").read_text(encoding="utf-8"))


def test_a_run_tells_what_it_starts_from(tmp_path: Path) -> None:
    """Also which state of the parent it was: a parent that goes on has another checkpoint."""
    parent = Simulation(CASE, output=tmp_path / "parent", threads=1)
    parent.run()
    assert record(tmp_path / "parent")["starts_from"] == {}
    assert record(tmp_path / "parent")["sources"]["digest"] == module.sources()["digest"]
    assert record(tmp_path / "parent")["device"] == "cpu"
    fluid = dataclasses.replace(CASE.fluid, start=Start(run=str(tmp_path / "parent")))
    child = dataclasses.replace(CASE, fluid=fluid)
    Simulation(child, output=tmp_path / "child", threads=1)
    (key, told), *more = record(tmp_path / "child")["starts_from"].items()
    state = (tmp_path / "parent" / "checkpoint.npz").read_bytes()
    assert (key, more) == ("fluid.start.run", [])
    assert told["path"] == str(tmp_path / "parent")
    assert told["sha256"] == hashlib.sha256(state).hexdigest()
    assert told["case_digest"] == record(tmp_path / "parent")["case_digest"]
    assert told["sources"] == record(tmp_path / "parent")["sources"]
    np.save(tmp_path / "r.npy", parent.engine.positions())
    fluid = dataclasses.replace(CASE.fluid, start=Start(positions=str(tmp_path / "r.npy")))
    Simulation(dataclasses.replace(CASE, fluid=fluid), output=tmp_path / "file", threads=1)
    told = record(tmp_path / "file")["starts_from"]["fluid.start.positions"]
    assert told["sha256"] == hashlib.sha256((tmp_path / "r.npy").read_bytes()).hexdigest()
