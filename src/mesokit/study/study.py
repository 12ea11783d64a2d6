"""A study: the same case for several values and seeds."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.case.describe.shown import Shown
from mesokit.case.outside import outside_parts
from mesokit.devices.named import require_name, require_there
from mesokit.devices.names import CPU
from mesokit.errors import CaseError, RunError
from mesokit.processes.cores import usable_cores
from mesokit.processes.world import world
from mesokit.run.opened import RunFiles
from mesokit.seam.method import on_devices, summary_of
from mesokit.study import definition
from mesokit.study import table as tables
from mesokit.study.axes import Axis
from mesokit.study.between import theory_between
from mesokit.study.cluster import Cluster
from mesokit.study.definition import CASE, FILE, seeds_of
from mesokit.study.dependence import Fitted, Theory, fitted
from mesokit.study.drive import StudyReporter, Workers, drive, reporter_for
from mesokit.study.local import Here, Processes
from mesokit.study.merge import merge
from mesokit.study.names import called
from mesokit.study.numbers import numbers, words_of
from mesokit.study.plan import Base, Planned, by_point, checked, make, planned, short_names
from mesokit.study.plot import curves_of, drawable, find_rows, plot, several
from mesokit.study.table import Pooled


class Study(Shown):
    """The same case for several values and seeds: a folder of runs, and their common results.

    Parameters
    ----------
    case : Case or path
        What all runs have in common, or the file of it.
    vary : mapping, optional
        By key path the values, a list or a range as a text ("0.05:0.2:4"); by a tuple of keys rows
        of values that belong together. Runs are made for every combination.
    seeds : int or sequence of int, optional
        So many seeds, from that of the case on, or which.
    settings : mapping, optional
        Values that replace those of the case in all runs, by key path.
    output : path
        Folder of the study. Runs that are in it already are kept, so that a study can be made
        larger, or go on after a stop.
    write : bool, optional
        False writes nothing: the runs are listed and their cases checked. `run` makes the folder.

    Raises
    ------
    CaseError
        For a case that cannot be, with the values that make it so; no folder is made then. On
        several ranks of MPI, for its runs are processes of its own.
    RunError
        Where another study lies, or a folder cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from mesokit import Box, Case, Conservation, Run
    >>> case = Case(run=Run(steps=20), box=Box([8, 8]), observe=[Conservation(every=5)])
    >>> folder = Path(tempfile.mkdtemp()) / "study"
    >>> study = Study(case, {"fluid.timestep": [0.1, 0.2]}, seeds=2, output=folder)
    >>> len(study.runs)
    4
    >>> study.run(jobs=1)
    >>> [(row.point["fluid.timestep"], row.key, row.runs) for row in study.table()][::2]
    [(0.1, 'largest-drift-of-momentum', 2), (0.2, 'largest-drift-of-momentum', 2)]
    """

    def __init__(
        self,
        case: Case | str | Path,
        vary: Mapping[Any, Any] | Sequence[Axis] | None = None,
        seeds: int | Sequence[int] = 1,
        *,
        output: str | Path,
        settings: Mapping[str, Any] | None = None,
        write: bool = True,
    ) -> None:
        require_one_process()  # before two ranks make the same folder
        base = Base.of(case, settings)
        self.path = Path(output)
        axes = Axis.from_mapping(vary) if isinstance(vary, Mapping) else list(vary or ())
        self._set(base, axes, seeds_of(seeds, base))
        self._make(write)

    @classmethod
    def open(
        cls, path: str | Path, output: str | Path | None = None, *, write: bool = True
    ) -> Study:
        """The study in a folder, or of a study file. Raises RunError or CaseError if there is none.

        A study file names a `case`, `seeds` and [[vary]] tables; its runs go to `output`, a folder
        of the name of the file in the working directory unless said. With `write=False` nothing is
        written.
        """
        path = Path(path)
        file = path / FILE if path.is_dir() else path
        if not file.is_file():
            raise RunError(f"{path}: holds no study; expected a file {FILE} in it")
        self = cls.__new__(cls)
        try:
            found = definition.read(file)
            self.path = path if path.is_dir() else Path(output or path.stem)
            self._set(*found)
            if not path.is_dir():
                self._make(write)
        except CaseError as error:
            raise CaseError(f"{file}: {error}") from None
        return self

    def _set(self, base: Base, axes: list[Axis], seeds: list[int]) -> None:
        self.base, self.axes, self.seeds = base, axes, seeds
        self.runs: list[Planned] = planned(axes, seeds, self.path)

    def _make(self, write: bool = True) -> None:
        """Make the folder and all runs that are not there; without `write` only check.

        Raises RunError if the folder has a study with other runs.
        """
        if (self.path / FILE).exists():
            ours = {run.path for run in self.runs}
            for run in Study.open(self.path).runs:
                if run.path not in ours:
                    raise RunError(
                        f"{self.path}: holds a study with other runs, such as "
                        f"{run.path.relative_to(self.path)}; name its values as well, or choose "
                        "another output"
                    )
        elif self.path.is_dir() and any(self.path.iterdir()):
            raise RunError(f"{self.path}: folder is not empty, and holds no study")
        cases = checked(self.runs, self.base)
        if write:
            make(cases)
            definition.write(self.path, self.base, self.axes, self.seeds)

    @property
    def keys(self) -> list[str]:
        """The key paths that are varied."""
        return [key for axis in self.axes for key in axis.keys]

    def warnings(self) -> list[str]:
        """Warnings of the cases, each once, with the first point unless it holds at all points."""
        found: dict[str, list[Planned]] = {}
        for run in (points := [group[0] for group in by_point(self.runs)]):
            for text in summary_of(run.files.case, 1).warnings:
                found.setdefault(text, []).append(run)
        return [
            text if len(runs) == len(points) else f"{runs[0].path.parent.name}: {text}"
            for text, runs in found.items()
        ]

    def require(self, x: str | None, y: str) -> None:
        """Raise CaseError for a picture that cannot be drawn, as known before the runs."""
        self.key(x) if x else None
        labels = [observable.label for observable in self._case.observe]
        for one in several(y):
            if not any(label.startswith(one) or one.startswith(label) for label in labels):
                name = one.partition(".")[0]
                why = (
                    f"no observable {show(name)}; expected {one_of(labels)}{nearest(name, labels)}"
                )
                raise CaseError(f"{one}: {why if labels else 'the case measures nothing'}")

    @property
    def _case(self) -> Case:
        """The case of the first run."""
        return self.base.case(self.runs[0].point, self.runs[0].seed)

    @property
    def ended(self) -> bool:
        """True if all runs have their results."""
        return all(run.ended for run in self.runs)

    def run(
        self,
        jobs: int | None = None,
        *,
        threads: int = 1,
        device: str = CPU,
        cluster: str | None = None,
        options: Mapping[str, Any] | None = None,
        progress: StudyReporter | bool | None = None,
    ) -> None:
        """Carry all runs that have not ended to their ends.

        Parameters
        ----------
        jobs : int, optional
            Runs at once: one for each core and its `threads` unless said; on a cluster, workers.
        threads : int, optional
            Threads of each run. Results do not depend on it.
        device : str, optional
            "cpu", or "cuda" for a card, on which one run at a time goes unless `jobs` are given.
        cluster : str, optional
            "slurm", "pbs", "sge", "lsf", "htcondor", "local" or the address of a Dask scheduler.
        options : mapping, optional
            Of the jobs of a cluster, such as {"queue": "long", "walltime": "10:00:00"}.
        progress : bool or StudyReporter, optional
            True shows progress, False says nothing; in a notebook there is a bar unless False.

        Raises RunError when all others have ended, if runs have failed. A signal raises
        KeyboardInterrupt when the runs in hand have come to a checkpoint; `run` again goes on.
        Raises CaseError on several ranks of MPI: its runs are processes of its own.
        """
        require_one_process()
        reporter = reporter_for(progress)
        if require_name(device) != CPU:
            on_devices(self._case, device, 1)
            if cluster is None:
                require_there(device)
        made = [self.path / FILE, *(run.path / CASE for run in self.runs)]
        if not all(file.exists() for file in made):  # not written yet, or removed
            self._make()
        workers = self._workers(jobs, threads, device, cluster, options)
        if failed := drive(self.runs, workers, reporter):
            run, why = failed[0]
            more = f" (and {len(failed) - 1} more)" if len(failed) > 1 else ""
            raise RunError(f"{run.path}: {why}{more}")

    def _workers(
        self, jobs: int | None, threads: int, device: str, cluster: str | None, options: Any
    ) -> Workers:
        modules = sorted({part["class"].partition(":")[0] for part in outside_parts(self._case)})
        places = jobs or (max(1, usable_cores() // threads) if device == CPU else 1)
        if "__main__" in modules:
            if cluster or jobs not in (None, 1):
                raise CaseError(
                    "parts of the case are defined in this script: put them into a module of their "
                    "own, so that other processes can import it, or let jobs be 1"
                )
            return Here(threads, device)
        if cluster:
            return Cluster(cluster, places, threads, modules, options, device)
        return Processes(min(places, len(self.runs)), threads, modules, device)

    def table(self) -> list[Pooled]:
        """Every compared number at every point, pooled over the seeds that have ended."""
        return tables.table(self.runs)

    def to_dataframe(self) -> Any:
        """The table as a pandas.DataFrame."""
        return tables.dataframe(self.table())

    def to_csv(self, path: str | Path | None = None) -> Path:
        """The table as a CSV file, `table.csv` in the folder unless said. Raises RunError."""
        return tables.write(self.table(), path or self.path / "table.csv")

    def plot(self, x: str, y: str, fit: str | None = None, **look: Any) -> Any:
        """One number against one value that is varied: a Matplotlib figure.

        Parameters
        ----------
        x : str
            A key that is varied, or its last part.
        y : str
            A number, such as "velocity-profile.viscosity", or several of one unit, with commas
            between them.
        fit : "line" or "power", optional
            Fit y = a + b x, or y = a x^b, to each curve.
        look : optional
            `width` of the figure, in inches; a column has 3.4. `log`, which axes are logarithmic:
            "x", "y", "x,y", True for both, False for none. Unless said, x is where its values are a
            geometric sequence, and y with it where numbers above zero span a decade.

        Raises CaseError for a key or number that is not there, with the nearest one, and for a
        logarithmic axis of values that are not above zero.
        """
        key = self.key(x)
        look = {"fit": fit, "between": self.theory_between} | look
        return plot(self.table(), self.axes, key, y, called(self._case, key), **look)

    def theory_between(
        self, rows: Sequence[Pooled], keys: Sequence[str], log: bool
    ) -> Theory | None:
        """Expectation of a number between its points, None if it cannot be computed."""
        return theory_between(self.base, self.runs, rows, keys, log)

    def fit(self, x: str, y: str, kind: str) -> list[Fitted]:
        """Fit y = a + b x ("line") or y = a x^b ("power") to each curve that `plot` draws.

        Of each, `formula` says what was found, and `fit` holds coefficients, errors, covariance and
        the quality, of the logarithms for a power. Raises CaseError as `plot` does, and for too few
        points with an error bar.
        """
        curves = curves_of(self.table(), self.axes, self.key(x), y)
        return [fitted(curve, kind) for curve in curves]

    def lines(self) -> list[str]:
        """The table in words, point after point."""
        return tables.lines(self.table(), self.keys)

    def save_pictures(self, ending: str = ".png", **look: Any) -> list[Path]:
        """Draw every number that has an error bar against the first key that is varied.

        `ending` is ".png", ".pdf" or ".svg"; `look` is that of `plot`.
        """
        names = drawable(self.table(), self.axes)
        return [self.save_picture(self.keys[0], name, ending=ending, **look) for name in names]

    def save_picture(
        self,
        x: str,
        y: str,
        fit: str | None = None,
        *,
        ending: str = ".png",
        path: str | Path | None = None,
        **look: Any,
    ) -> Path:
        """Draw one number against one varied value into a file, as `plot` does.

        The file lies in the folder unless `path` says where.
        """
        from mesokit.report import save_figure
        from mesokit.report.finish.origin import Origin

        figure, names = self.plot(x, y, fit, **look), short_names(self.keys)
        origin = filter(None, [self._case.title, f"study {self.path.name}"])
        figure.origin = Origin(", ".join(origin))
        table = self.table()
        number = "-and-".join(find_rows(table, name)[0].name for name in several(y))
        file = f"{number}-against-{names[self.keys.index(self.key(x))]}{ending}"
        return save_figure(figure, path or self.path / file)

    def report(self, path: str | Path | None = None) -> Path:
        """Write one HTML file with all of the study, also of one that has not ended.

        It holds the numbers and pictures of all points, what is varied, the case, a list of the
        runs, and how to repeat it; `report.html` in the folder of the study unless said. Raises
        RunError.
        """
        from mesokit.study.document import write_report

        return write_report(self, path)

    def merged(self, point: int = 0) -> RunFiles:
        """The runs of one point as one, with pooled observables, in a folder `merged` beside them.

        It is made anew. Raises RunError as `mesokit.merge` does.
        """
        runs = list(by_point(self.runs))[point]
        output = runs[0].path.parent / "merged"
        shutil.rmtree(output, ignore_errors=True)
        return merge([run.path for run in runs], output)

    def key(self, name: str) -> str:
        """The varied key of that name, in whole or its last part. Raises CaseError."""
        names = dict(zip(short_names(self.keys), self.keys, strict=True))
        if name in self.keys:
            return name
        if name in names:
            return names[name]
        hint = nearest(name, [*names, *self.keys])
        raise CaseError(f"{name}: not varied; expected {one_of(list(names))}{hint}")

    def record(self) -> dict[str, Any]:
        """The record that `mesokit info --json` prints: plain numbers and texts."""
        return {
            "study": str(self.path),
            "ended": self.ended,
            "varied": {key: values for axis in self.axes for key, values in axis.table().items()},
            "seeds": self.seeds,
            "runs": [{"run": str(run.path), "state": run.state} for run in self.runs],
            "numbers": [row.row() for row in self.table()],
        }

    def __len__(self) -> int:
        return len(self.runs)

    def _card(self) -> dict[str, Any]:
        axes = (item for axis in self.axes for item in axis.table().items())
        varied = [(key, ", ".join(words_of(values)), "") for key, values in axes]
        rows = self.table()
        return {
            "title": f"mesokit study {self.path}",
            "words": self._state(),
            "rows": [*varied, ("run.seed", ", ".join(map(str, self.seeds)), "")],
            "numbers": numbers(rows, self.keys) if rows else None,
            "text": self.base.text,
            "fold": "the case",
        }

    def _state(self) -> str:
        return f"{sum(run.ended for run in self.runs)} of {len(self)} runs have ended"

    def __repr__(self) -> str:
        varied = "".join(f"  {axis.keys[0]}: {len(axis.values)} values\n" for axis in self.axes)
        return f"mesokit study {self.path}: {self._state()}\n{varied}  {len(self.seeds)} seeds"


def require_one_process() -> None:
    """Raise CaseError on several ranks of MPI."""
    ranks = world().size
    if ranks > 1:
        raise CaseError(f"Study: not on {ranks} ranks; expected one process, no mpiexec")
