"""Files of a run: results, trajectory, log and record."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from mesokit.case import toml
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.describe.shown import Shown
from mesokit.errors import CaseError, RunError
from mesokit.io import checkpoint, h5md, log_file, tables
from mesokit.io.frames import require_frames, seen_until
from mesokit.io.measured import fitting, measured
from mesokit.io.record_words import merge_again, pooled_words, work_words
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.observe.shared.build_up import result_of
from mesokit.run import pictures
from mesokit.seam.in_units import in_units
from mesokit.seam.method import absorbed_words, method_of
from mesokit.seam.named import keyed
from mesokit.seam.result import Comparison, Result

if TYPE_CHECKING:  # it loads the libraries of pictures
    from mesokit.report.flow import Film


class RunFiles(Shown, Mapping[str, Result]):
    """Files of a run, read when they are needed: a mapping of its results by name.

    `files["velocity-profile"]` is a result, `list(files)` their names; `case`, `provenance`,
    `results`, `trajectory`, `log` and `si` are the rest. Raises RunError if a file is missing or
    damaged.
    """

    def __init__(self, path: str | Path) -> None:
        self.directory = RunDirectory.existing(path)
        self.path = self.directory.path

    @cached_property
    def case(self) -> Case:
        """The resolved case."""
        return Case.from_toml(self.directory.case_file)

    @cached_property
    def provenance(self) -> dict[str, Any]:
        """Versions, seed, host, times."""
        return self.directory.read_provenance()

    @property
    def pooled(self) -> str:
        """Number and seeds of the merged runs, "" for a run that is not merged."""
        with contextlib.suppress(RunError):  # results can be read without the record
            return pooled_words(self.provenance)
        return ""

    @property
    def results(self) -> dict[str, Result]:
        """Results by name: those so far, by the last checkpoint, if the run has not ended.

        Raises RunError if there are none yet.
        """
        if self.ended:
            return self._final
        if not self.directory.checkpoint_file.exists():
            raise RunError(f"{self.path}: the run {self.state}")
        made, _ = measured(self.directory, self.case)
        with fitting(self.directory.checkpoint_file):
            return {name: result_of(one, self.case) for name, one in made.items()}

    @cached_property
    def _final(self) -> dict[str, Result]:
        with self._advising():
            found = h5md.read_results(self._data())
            return {name: in_units(result, self.case) for name, result in found.items()}

    @cached_property
    def si(self) -> Any:
        """The numbers in SI units. Raises CaseError for a case without `units`."""
        convert = method_of(self.case).si
        if convert is None:
            raise CaseError(f"units: method {show(self.case.run.method)} does not know them in SI")
        return convert(self.case)

    @property
    def log(self) -> NDArray[Any]:
        """Numbers in time, as `files.log["temperature"]`; also while the run goes on.

        A structured array with a field for each column: `pandas.DataFrame(files.log)` is a table.
        Raises RunError if the case has none.
        """
        if self.case.log is None:
            raise RunError(f"{self.path}: the case has no [log]")
        return log_file.read(self.directory.log_file)

    @cached_property
    def trajectory(self) -> TrajectoryReader | None:
        """Frames, None if the case has none. Raises RunError if the run has not ended."""
        with self._advising():
            reader = TrajectoryReader(self._data())
        return reader if reader.fields else None

    def __getitem__(self, name: str) -> Result:
        """The result of that name; KeyError lists the names."""
        if name not in self.results:
            raise KeyError(f"no result {name!r}; there are {', '.join(self.results) or 'none'}")
        return self.results[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.results)

    def __len__(self) -> int:
        return len(self.results)

    def __bool__(self) -> bool:
        return True  # also without results

    __eq__ = object.__eq__  # equal results do not make runs equal
    __hash__ = object.__hash__

    def comparisons(self) -> dict[str, Comparison]:
        """All comparisons of the run, by `result.key`: `velocity-profile.slip-at-the-walls`."""
        return {
            f"{name}.{key}": comparison
            for name, result in self.results.items()
            for key, comparison in keyed(result.comparisons).items()
        }

    def to_dataframe(self) -> Any:
        """All comparisons as a pandas.DataFrame, a row for each.

        Raises CaseError without `pip install 'mesokit[tables]'`.
        """
        return tables.rows_dataframe(self.results)

    def to_csv(self, path: str | Path) -> Path:
        """Write all comparisons as a CSV file, a row for each. Raises RunError."""
        return tables.write_rows(self.results, path)

    def record(self) -> dict[str, Any]:
        """The record that `mesokit info --json` prints: plain numbers and texts."""
        results = self.so_far()
        return {
            "run": str(self.path),
            "title": self.case.title,
            "ended": self.ended,
            "state": (self.pooled or "has ended") if self.ended else self.state,
            "fingerprint": self._fingerprint_or_reason(),
            "case": toml.parse(self.case.to_toml()),
            "provenance": self.provenance,
            "results": [
                {name: getattr(r, name) for name in ("name", "quantity", "label", "samples")}
                | {"shape": {key: len(axis) for key, axis in r.x.items()}}
                for r in results.values()
            ],
            "comparisons": tables.rows(results),
        }

    @property
    def ended(self) -> bool:
        """True if the run has ended and has results, and its case was not made longer since."""
        if not self.directory.data_file.exists():
            return False
        with contextlib.suppress(RunError):  # results outlive a checkpoint
            step = checkpoint.read_meta(self.directory.checkpoint_file)["step"]
            return bool(step >= self.case.run.warmup + self.case.run.steps)
        return True

    @property
    def fingerprint(self) -> str:
        """Twelve hexadecimal digits made of the bits of the last checkpoint; "" without one.

        Two runs have the same if all particles and all that observables have seen have the same
        bits; the trajectory is not in it. Raises RunError for a damaged checkpoint.
        """
        file = self.directory.checkpoint_file
        return checkpoint.fingerprint(file) if file.exists() else ""

    def _fingerprint_or_reason(self) -> str:
        """The fingerprint, or why there is none: a damaged checkpoint; "" without a checkpoint."""
        try:
            return self.fingerprint
        except RunError as error:
            return f"none: {error}"

    def report(self, path: str | Path | None = None, films: bool = False) -> Path:
        """Write one HTML file with all of the run: see `mesokit.report.document.write_report`.

        `files.report()` writes `report.html` into the folder of the run; `films` puts small films
        into it. Raises RunError if it cannot be written.
        """
        from mesokit.report.document import write_report

        return write_report(self, path, films)

    def plot(
        self, folder: str | Path | None = None, *, ending: str = ".png", width: float | None = None
    ) -> list[Path]:
        """Draw every result into the folder (that of the run unless said).

        `ending` is ".png", ".pdf" or ".svg", `width` that of the figures, in inches.
        """
        from mesokit.report import save_all

        own = self.results.values(), folder or self.path, self.case
        return save_all(*own, ending=ending, width=width, run=self._name)

    def flow(self, kind: str | None = None, **choices: Any) -> Any:
        """A picture of the flow, with the choices of `mesokit.report.flow.picture`.

        `files.flow("speed", region=((0, 20), (0, 10)), window=(50, 90))` is a Matplotlib figure;
        `width` is that of the figure, in inches.
        """
        return pictures.flow(self.case, self.results, self.trajectory, self._name, kind, choices)

    def animate(self, path: str | Path, kind: str | None = None, **choices: Any) -> Film:
        """Write a film of the flow, MP4 or GIF by its ending; see `mesokit.report.flow.animate`.

        `files.animate("film.mp4", "vorticity", window=(50, 90), fps=10)` writes the file.
        """
        own = self.results, self.trajectory, self._name
        return pictures.film(self.case, *own, kind, choices, path)

    @property
    def _name(self) -> str:
        """The name of the run in pictures: its folder."""
        return self.path.resolve().name

    def universe(self) -> Any:
        """The trajectory as an MDAnalysis `Universe`, with kinds, masses, molecules and bonds.

        All frames are in memory; a cell is an angstrom there, and a unit of time a picosecond.
        Raises CaseError without MDAnalysis, RunError without frames.
        """
        from mesokit.io.export import contents
        from mesokit.io.mdanalysis import require, universe

        require()
        return universe(*contents(self.directory, self.case, lambda: self.trajectory))

    def export(
        self, path: str | Path, states: Sequence[str] | None = None, pixels: int | None = None
    ) -> Path:
        """Write the trajectory for another program, in the format of the ending.

        `.gsd` is for OVITO, HOOMD-blue and MDAnalysis; `.lammpstrj` and `.xyz` are text; `.h5md`,
        `.dcd`, `.xtc` and `.trr` have all frames, `.data` (LAMMPS) the last. Contacts of grains go
        to `.csv`, a table, or to `.local`, a dump of local data as LAMMPS has them. Sites of a
        lattice go to `.xyz`, of some `states` or all; to `.vti`, a file for each frame for
        ParaView, listed in a file `.pvd`; or to `.png`, an image of each frame with so many
        `pixels` (1 unless said) along each side of a site. Raises CaseError for any other, RunError
        without frames of places.
        """
        from mesokit.io.export import export

        images = pictures.site_images(self.case, path, pixels)
        return export(self.directory, self.case, lambda: self.trajectory, path, states, images)

    def _data(self) -> Path:
        if not self.directory.data_file.exists():
            raise RunError(f"{self.path}: the run {self.state}")
        return self.directory.data_file

    @contextlib.contextmanager
    def _advising(self) -> Iterator[None]:
        """Add to the error of a damaged data file how to restore it."""
        try:
            yield
        except RunError as error:
            if not self.directory.data_file.exists():  # the error is complete
                raise
            raise RunError(f"{error}; {self._advice()}") from None

    def _advice(self) -> str:
        if self.pooled:
            return f"merge its runs again: {merge_again(self.provenance, self.path)}"
        try:
            _, meta = checkpoint.read(self.directory.checkpoint_file)
            require_frames(self.directory, self.case, seen_until(meta))
        except RunError:
            return f"put a copy in its place, or run anew: {self.directory.again}"
        return f"mesokit resume {self.path} writes it again"

    @property
    def state(self) -> str:
        """State of a run without results, and how to go on."""
        failed, file = None, self.directory.checkpoint_file
        with contextlib.suppress(RunError):  # a run goes on without its record
            failed = self.provenance.get("failed")
        if self.pooled:
            return f"was {self.pooled}, but has no results; {self._advice()}"
        last = self.case.run.warmup + self.case.run.steps
        reached = "it has no checkpoint yet"
        if file.exists():
            meta = checkpoint.read_meta(file)
            reached = f"its last checkpoint is at step {meta['step']} of {last}"
            try:
                require_frames(self.directory, self.case, seen_until(meta))
            except RunError as error:
                return f"cannot go on: {reached}, but {error}"
        if failed:
            return f"failed: {failed} ({reached})"
        how = f"if it is not running any more, go on with: mesokit resume {self.path}"
        return f"has not ended: {reached}; {how}"

    def so_far(self) -> dict[str, Result]:
        """The results, {} if there are none yet or their file is lost."""
        with contextlib.suppress(RunError) if not self.ended else contextlib.nullcontext():
            return self.results
        return {}

    def _card(self) -> dict[str, Any]:
        how = self.pooled if self.ended else self.state
        return {
            "title": f"mesokit run {self.path}",
            "words": ": ".join(filter(None, [self.case.title, how])),
            "results": self.so_far().values(),
            "text": self.case.to_toml(),
            "fold": "the case",
        }

    def _length(self) -> str:
        """Steps of the run, its simulated time, and the date of its end."""
        run = self.case.run
        end = (run.warmup + run.steps) * method_of(self.case).timestep(self.case)
        words = f"{run.steps} step{'s' * (run.steps != 1)}"
        words += f" after {run.warmup} of warm-up" * (run.warmup > 0)
        words += f", to time {end:.6g}"
        with contextlib.suppress(RunError):
            if date := self.provenance.get("ended"):
                words += f"; ended {str(date).replace('T', ' ').replace('+00:00', ' UTC')}"
        return words

    def __repr__(self) -> str:
        lines = [f"mesokit run {self.path}"]
        lines += [f"  {self.case.title}"] * bool(self.case.title)
        if self.case.units is not None:
            lines.append("  " + str(self.si).replace("\n", "\n  "))
        lines.append(f"  {(self.pooled or self._length()) if self.ended else self.state}")
        with contextlib.suppress(RunError):  # results can be read without the record
            if lost := self.directory.record_lost:
                lines.append(f"  warning: {lost}")
            if digits := self._fingerprint_or_reason():
                lines.append(f"  fingerprint {digits}")
            lines += [f"  {line}" for line in work_words(self.provenance)]
            if words := absorbed_words(self.provenance.get("absorbed")):
                lines.append(f"  {words}")
            lines += [f"  warning: {words}" for words in self.provenance.get("warnings", ())]
        lines += ["  " + repr(result).replace("\n", "\n  ") for result in self.so_far().values()]
        if self.ended and self.trajectory is not None:
            lines.append(f"  {self.trajectory!r}")
        return "\n".join(lines)


def open(path: str | Path) -> RunFiles:
    """Files of the run in the folder `path`. Raises RunError if there is no run.

    Several runs of the same case become one by `mesokit.merge`.
    """
    if not isinstance(path, str | Path):
        hint = "mesokit.merge(runs, output) makes one of several of the same case"
        raise RunError(f"open({show(path)}): expected the folder of one run; {hint}")
    return RunFiles(path)
