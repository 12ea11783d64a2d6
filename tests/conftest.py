"""What holds for all tests, and fixtures that several folders ask for."""

import math
import os
import shutil

import pytest
from filelock import FileLock
from hypothesis import settings

# Workers are started after this: BLAS would take a thread for each core in each of them, and then
# wait on the one core that each is given, ten times as long.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
worker = os.environ.get("PYTEST_XDIST_WORKER")  # "gw0", "gw1", ...
if worker and hasattr(os, "sched_setaffinity"):  # not on every system
    # A core each: runs take all cores that they are given, and threads of several runs that wait
    # for one another on the same cores make all of them slow.
    cores = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {cores[int(worker[2:]) % len(cores)]})

settings.register_profile("same every time", derandomize=True, deadline=None)
settings.load_profile("same every time")

pytest.register_assert_rewrite("tests.helpers")
collect_ignore = ["helpers"]  # no doctests there


BLANK = "--blank-expectations"


def pytest_addoption(parser):
    """A switch that makes each test of theory fail: one that passes asserts nothing."""
    parser.addoption(BLANK, action="store_true", help="results of tests expect nothing")


def pytest_configure(config):
    """Results without any expectation, where the switch says so."""
    if not config.getoption(BLANK):
        return
    from mesokit.seam.result import Comparison, Result

    def without(kind, name, nothing):
        made = kind.__init__

        def blank(self, *given, **named):
            made(self, *given, **named)
            object.__setattr__(self, name, nothing)

        kind.__init__ = blank

    without(Comparison, "expected", math.nan)
    without(Result, "expected", None)


@pytest.fixture(autouse=True, scope="session")
def machine_in_no_hurry():
    """What takes long says so: on a machine with much else to do, what a test asks for would."""
    from mesokit.cli import words

    words.SILENT = 3600.0


@pytest.fixture(scope="session")
def once(tmp_path_factory):
    """Fill a folder of some name once for all workers; those that come later wait for it."""
    base = tmp_path_factory.getbasetemp()
    base = base.parent if worker else base

    def made(name, fill):
        folder, done = base / name, base / f"{name}.done"
        with FileLock(base / f"{name}.lock"):
            if not done.exists():
                shutil.rmtree(folder, ignore_errors=True)  # of a worker where that failed
                folder.mkdir()
                fill(folder)
                done.touch()
        return folder

    return made


@pytest.fixture
def flying(monkeypatch):
    """The method `flying-spheres`, whose name is answered."""
    from mesokit.case import methods
    from mesokit.case.case import case_class
    from tests.helpers import flying_spheres

    monkeypatch.setitem(methods.METHODS, flying_spheres.NAME, flying_spheres.__name__)
    yield flying_spheres.NAME
    case_class.cache_clear()


@pytest.fixture
def make_case():
    """A case from a box, observables and what else differs from the defaults."""
    from tests.helpers.small_fluids import make_case

    return make_case
