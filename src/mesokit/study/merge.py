"""Runs of one case as one: their samples are pooled, not their results.

Blocks of time of all runs stand in a row. So ratios and fits are those of all samples, and error
bars contain both the correlations within a run and the scatter of runs.
"""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import RunError
from mesokit.io import h5md
from mesokit.io.atomic import delete_folder
from mesokit.io.measured import measured
from mesokit.io.provenance import now, provenance
from mesokit.io.run_directory import RunDirectory
from mesokit.observe.shared.build_up import result_of
from mesokit.observe.shared.caveats import with_those_of
from mesokit.run.opened import RunFiles
from mesokit.seam.pooled import pool
from mesokit.seam.result import Result

MAY_DIFFER = (  # beginnings of keys
    "run.seed",
    "run.replicas",
    "run.steps",
    "run.checkpoint_",
    "trajectory.",
    "log.",
    "title",
)


def merge(runs: Sequence[str | Path], output: str | Path) -> RunFiles:
    """Pool the observables of runs of one case into a new folder, which opens as a run does.

    Parameters
    ----------
    runs: folders of runs whose cases differ in their seeds, and at most in how long they are. One
        that has not ended counts up to its last checkpoint.
    output: folder to write to: results, figures, the case of the first run, and where all came
        from.

    Raises RunError for runs of different cases, with the first key that differs, for the same seed
    twice, for observables that cannot be pooled, or if a folder holds no run or checkpoint.

    >>> import tempfile
    >>> from mesokit import Box, Case, Conservation, Run, Simulation
    >>> folder = Path(tempfile.mkdtemp())
    >>> for seed in (1, 2):
    ...     run = Run(steps=20, seed=seed)
    ...     case = Case(run=run, box=Box([8, 8]), observe=[Conservation(every=5)])
    ...     Simulation(case, output=folder / f"{seed}").run()
    >>> merge([folder / "1", folder / "2"], folder / "both")["conservation"].samples
    10
    """
    if len(runs) < 2:
        raise RunError(f"merge: {len(runs)} run: expected two or more")
    files = [RunFiles(run) for run in runs]
    _require_alike(files)
    together = pooled(files)
    for why in together.refused.values():
        raise why
    record = [
        {"run": str(one.path.resolve()), "seed": one.case.run.seed, "step": step}
        for one, step in zip(files, together.steps, strict=True)
    ]
    warned = dict.fromkeys(words for one in files for words in one.provenance.get("warnings", ()))
    own = {"merged": record, "warnings": list(warned)}
    return _write(files[0].case, together.results, own, output)


class Together(NamedTuple):
    """Results from the samples of several runs, errors of observables that cannot be pooled, and
    the last step of each run."""

    results: list[Result]
    refused: dict[str, RunError]
    steps: list[int]


def pooled(runs: Sequence[RunFiles]) -> Together:
    """The observables of runs of one case, with the samples of all.

    Raises CheckpointError for a run without the checkpoint that holds its samples.
    """
    accumulators, step = measured(runs[0].directory, runs[0].case)
    refused, steps = {}, [step]
    for run in runs[1:]:
        more, step = measured(run.directory, run.case)
        steps.append(step)
        for name in [name for name in accumulators if name not in refused]:
            try:
                pool(name, accumulators[name], more[name])
            except RunError as error:
                refused[name] = error
    each = [run.results for run in runs]
    results = [
        with_those_of(result_of(a, runs[0].case), [own[name] for own in each])
        for name, a in accumulators.items()
        if name not in refused
    ]
    return Together(results, refused, steps)


def _write(
    case: Case, results: Sequence[Result], own: dict[str, Any], output: str | Path
) -> RunFiles:
    """Write the folder of the merged run: whole, or not at all."""
    from mesokit.report import save_all

    output = Path(output)
    RunDirectory(output).require_empty()
    coming = output.with_name(f".{output.name}.part")
    delete_folder(coming)  # we may have been killed here before
    directory = RunDirectory.create(coming, case)
    try:
        kept = provenance(case, threads=0) | {"ended": now()} | own
        h5md.write(directory.data_file, case, kept, results)
        directory.write_provenance(kept)
        save_all(results, directory.path, case, run=output.resolve().name)
        if output.is_dir():
            output.rmdir()  # empty; Windows renames onto none
        coming.rename(output)
    except OSError as error:
        raise RunError(f"{output}: {(error.strerror or str(error)).lower()}") from None
    finally:
        delete_folder(coming)
    return RunFiles(output)


def _require_alike(files: Sequence[RunFiles]) -> None:
    """Raise RunError unless all runs are of one case, each with a seed of its own."""
    first = files[0]
    seeds: dict[int, Path] = {}
    for each in files:
        if "merged" in each.provenance:
            raise RunError(f"{each.path}: holds merged runs; name those that it is made of")
        # files that runs keep in their folders are named without the folder
        here, there = (flat(one.case.to_toml(one.path)) for one in (first, each))
        key = different_key(here, there, MAY_DIFFER)
        if key is not None:
            raise RunError(
                f"{each.path}: another case than {first.path}: {key} = {show(there.get(key))}, "
                f"not {show(here.get(key))}"
            )
        for seed in each.case.run.seeds:
            if seed in seeds:
                raise RunError(
                    f"{each.path}: run.seed = {seed}, as in {seeds[seed]}: the same run would "
                    "count twice"
                )
            seeds[seed] = each.path


def different_key(
    one: Mapping[str, Any], other: Mapping[str, Any], may_differ: tuple[str, ...]
) -> str | None:
    """The first key path that differs between two cases, without those that may; None if none does.

    >>> different_key({"run.seed": 1, "box.size": [8, 8]}, {"box.size": [8, 9]}, ("run.seed",))
    'box.size'
    """
    for key in [*one, *(key for key in other if key not in one)]:
        if not key.startswith(may_differ) and one.get(key) != other.get(key):
            return key
    return None


def flat(text: str) -> dict[str, Any]:
    """The values of a case file by their key paths."""
    found: dict[str, Any] = {}

    def walk(path: str, value: Any) -> None:
        if isinstance(value, Mapping):
            for key, inner in value.items():
                walk(f"{path}.{key}" if path else key, inner)
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            for number, inner in enumerate(value, 1):
                walk(f"{path}.{number}", inner)
        else:
            found[path] = value

    walk("", tomllib.loads(text))
    return found
