"""Runs on a cluster, by way of Dask: its workers take them, one at a time each.

Source: Dask and dask-jobqueue, which start workers as jobs of Slurm, PBS and others.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.io.optional import package
from mesokit.study.work import carry

QUEUES = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "htcondor": "HTCondorCluster",
}
LEAST = {"cores": 1, "processes": 1, "memory": "2GB"}  # of a job, where its settings say nothing


class Cluster:
    """Workers of Dask.

    Parameters
    ----------
    kind: "slurm", "pbs" ... (a job of that queue for each worker), "local" (processes of this
        machine), or the address of a scheduler that runs, such as "tcp://node1:8786".
    jobs: workers to start; those of a scheduler that runs are there already.
    options: of the jobs, such as {"queue": "long", "walltime": "10:00:00"}; what is not given
        is taken from Dask's own settings (jobqueue.yaml).

    Raises CaseError for an unknown kind or option, or if Dask is not installed.
    """

    def __init__(
        self,
        kind: str,
        jobs: int,
        threads: int = 1,
        modules: Sequence[str] = (),
        options: Mapping[str, Any] | None = None,
    ) -> None:
        distributed = package("distributed", "studies on a cluster", "cluster")
        self.threads, self.modules, self.own = threads, tuple(modules), None
        if "://" in kind:
            self.client = distributed.Client(kind)
            return
        if kind == "local":
            self.own = distributed.LocalCluster(
                n_workers=jobs, threads_per_worker=1, dashboard_address=None, **(options or {})
            )
        elif kind in QUEUES:
            self.own = self._queue(kind, threads, dict(options or {}))
            self.own.scale(jobs=jobs)
        else:
            raise CaseError(
                f"cluster = {show(kind)}: expected {one_of(['local', *QUEUES])}, or the address of "
                f"a scheduler, such as tcp://node1:8786{nearest(kind, ['local', *QUEUES])}"
            )
        self.client = distributed.Client(self.own)

    @staticmethod
    def _queue(kind: str, threads: int, options: dict[str, Any]) -> Any:
        made = getattr(package("dask_jobqueue", "jobs of a queue", "cluster"), QUEUES[kind])
        import dask

        known = dask.config.get(f"jobqueue.{kind}", {}) or {}
        if kind == "slurm":  # one thread of Dask for each run, whatever it uses itself
            options.setdefault("job_cpu", threads)
        least = LEAST if kind == "slurm" else LEAST | {"cores": threads}
        for name, value in least.items():
            if known.get(name) is None:
                options.setdefault(name, value)
        try:
            return made(**options)
        except (TypeError, ValueError) as error:
            raise CaseError(f"cluster = {show(kind)}: {error}") from None

    @property
    def places(self) -> int:
        """How many runs the workers that are there take at once."""
        return max(1, len(self.client.ncores()))

    def submit(self, path: Path) -> Any:
        """Carry the run in a folder, which all workers see, to its end."""
        work = carry, str(path.resolve()), self.threads, self.modules
        return self.client.submit(*work, pure=False)

    def stop(self) -> None:
        """Runs that are on other machines end with their workers, at their last checkpoints."""

    def close(self) -> None:
        """End the workers that were started here."""
        self.client.close()
        if self.own is not None:
            self.own.close()
