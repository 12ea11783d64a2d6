"""The plugin of the tests' durations adds up the phases of a test and of a folder."""

import runpy
from pathlib import Path
from types import SimpleNamespace

durations = SimpleNamespace(**runpy.run_path(str(Path(__file__).parents[1] / "durations.py")))


PHASES = {"setup": (0.5, 0.25), "call": (1.0, 0.5), "teardown": (0.25, 0.0)}


def reports(test: str) -> list[SimpleNamespace]:
    return [
        SimpleNamespace(nodeid=test, when=when, duration=seconds, cpu_seconds=cpu)
        for when, (seconds, cpu) in PHASES.items()
    ]


def test_phases_are_added_up_and_are_in_the_file_before_the_end(tmp_path: Path) -> None:
    path = tmp_path / "new" / "test.csv"
    plugin = durations.Durations(path)
    names = ["tests/laws/test_a.py::test_x[a, b]", "src/mesokit/a/b.py::mesokit.a.b"]
    for report in [*reports(names[0]), *reports(names[1]), *reports("cut off")[:2]]:
        plugin.pytest_runtest_logreport(report)
    rows = durations.read(path)
    assert rows == [(name, 1.75, 0.75) for name in names]
    assert [row.folder for row in rows] == ["tests/laws", "src"]
    assert durations.text(rows).splitlines()[-1].split() == ["3.5", "1.5", "2", "all"]


def test_a_worker_that_dies_measures_nothing() -> None:
    plugin = durations.Durations(None)
    died = SimpleNamespace(nodeid="tests/a.py::test_b", when="call", duration=2.0)
    plugin.pytest_runtest_logreport(died)
    assert plugin.rows == {died.nodeid: (died.nodeid, 2.0, 0.0)}
