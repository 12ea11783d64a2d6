"""Runs on a cluster: by workers of Dask, or by a job array of Slurm.

Source: Dask and dask-jobqueue, which start workers as jobs of Slurm, PBS and others.
"""

import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mesokit.case.component import nearest, one_of, show
from mesokit.devices.names import CPU
from mesokit.errors import CaseError
from mesokit.io.atomic import write_text
from mesokit.io.optional import package
from mesokit.study.work import carry

QUEUES = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "htcondor": "HTCondorCluster",
}
LEAST = {"cores": 1, "processes": 1, "memory": "2GB"}  # of a job without settings
SCRIPT = """\
#!/bin/bash
# The runs of a study, a job each. Submit it with: sbatch {name}
# Jobs that are cut off go on from their checkpoints when it is submitted again; what has ended is
# not repeated. When all have ended: mesokit study {folder}
#SBATCH --job-name={job}
#SBATCH --array=1-{runs}
#SBATCH --cpus-per-task={threads}
{card}#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --output={folder}/job-%A_%a.txt
cd {here}
exec {python} -m mesokit study {folder} --only "$SLURM_ARRAY_TASK_ID" --threads {threads}{more}
"""


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
        device: str = CPU,
    ) -> None:
        distributed = package("distributed", "studies on a cluster", "cluster")
        self.threads, self.modules, self.own = threads, tuple(modules), None
        self.device = device
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
        return max(1, len(self.client.ncores()))

    def submit(self, path: Path) -> Any:
        run = str(path.resolve())
        given = run, self.threads, self.modules, self.device
        return self.client.submit(carry, *given, pure=False)

    def stop(self) -> None:
        """Runs that are on other machines end with their workers, at their last checkpoints."""

    def close(self) -> None:
        self.client.close()
        if self.own is not None:
            self.own.close()


def write_job_array(folder: Path, runs: int, threads: int = 1, device: str = CPU) -> Path:
    """Write the script `job-array.sh` into the folder of a study. Raises RunError.

    On a device each job asks for a card.

    Slurm sends SIGUSR1 two minutes before the end, upon which a run writes a checkpoint.
    """
    path = folder / "job-array.sh"
    text = SCRIPT.format(
        name=shlex.quote(str(path)),
        folder=shlex.quote(str(folder)),
        job=shlex.quote(folder.name),
        runs=runs,
        threads=threads,
        card="" if device == CPU else "#SBATCH --gres=gpu:1\n",
        more="" if device == CPU else f" --device {shlex.quote(device)}",
        here=shlex.quote(str(Path.cwd())),
        python=shlex.quote(sys.executable),
    )
    return write_text(path, text)
