"""The plugin of the tests' durations adds up the phases of a test and of a folder."""

import runpy
from pathlib import Path
from types import SimpleNamespace

durations = SimpleNamespace(**runpy.run_path(str(Path(__file__).parents[1] / "durations.py")))


def report(test: str, seconds: float, cpu: float) -> SimpleNamespace:
    return SimpleNamespace(nodeid=test, duration=seconds, cpu_seconds=cpu)


def test_phases_are_added_up_and_come_back_from_the_file(tmp_path: Path) -> None:
    plugin, path = durations.Durations(None), tmp_path / "new" / "test.csv"
    names = ["tests/laws/test_a.py::test_x[a, b]", "src/mesokit/a/b.py::mesokit.a.b"]
    for name in names:
        for seconds, cpu in [(0.5, 0.25), (1.0, 0.5), (0.25, 0.0)]:
            plugin.pytest_runtest_logreport(report(name, seconds, cpu))
    durations.write(path, plugin.rows.values())
    rows = durations.read(path)
    assert rows == [(name, 1.75, 0.75) for name in names]
    assert [row.folder for row in rows] == ["tests/laws", "src"]
    assert durations.text(rows).splitlines()[-1].split() == ["3.5", "1.5", "2", "all"]
