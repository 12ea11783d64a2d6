"""A study as a job array of Slurm: plain, without anything that runs beside it."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mesokit.io.atomic import write_text

if TYPE_CHECKING:
    from mesokit.study.study import Study

SCRIPT = """\
#!/bin/bash
# The runs of a study, a job each. Submit it with: sbatch {name}
# Jobs that are cut off go on from their checkpoints when it is submitted again; what has ended is
# not repeated. When all have ended: mesokit study {folder}
#SBATCH --job-name={job}
#SBATCH --array=1-{runs}
#SBATCH --cpus-per-task={threads}
#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --output={folder}/job-%A_%a.txt
cd {here}
exec {python} -m mesokit study {folder} --only "$SLURM_ARRAY_TASK_ID" --threads {threads}
"""


def write_job_array(study: Study, threads: int = 1) -> Path:
    """Write the script `job-array.sh` into the folder of a study. Raises RunError.

    Slurm sends SIGUSR1 two minutes before the end, upon which a run writes a checkpoint.
    """
    path = study.path / "job-array.sh"
    text = SCRIPT.format(
        name=shlex.quote(str(path)),
        folder=shlex.quote(str(study.path)),
        job=shlex.quote(study.path.name),
        runs=len(study.runs),
        threads=threads,
        here=shlex.quote(str(Path.cwd())),
        python=shlex.quote(sys.executable),
    )
    write_text(path, text)
    return path
