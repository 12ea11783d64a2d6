"""Studies on a cluster: a queue that starts its jobs at once, as far as this machine can tell."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from mesokit import Study
from mesokit.errors import CaseError
from mesokit.study.cluster import Cluster

SBATCH = """#!/bin/sh
for script; do :; done
cp "$script" "{folder}/job.sh"
sh "{folder}/job.sh" > "{folder}/job.txt" 2>&1 &
echo "Submitted batch job 7"
"""


@pytest.fixture
def slurm(tmp_path, monkeypatch) -> Path:
    """Commands of Slurm: `sbatch` runs a job beside, `scancel` does nothing."""
    folder = tmp_path / "slurm"
    folder.mkdir()
    for name, text in (("sbatch", SBATCH.format(folder=folder)), ("scancel", "#!/bin/sh\n")):
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(folder), prepend=os.pathsep)
    monkeypatch.setenv("DASK_CONFIG", str(tmp_path / "none"))
    return folder


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="no queues there")
def test_jobs_of_slurm(slurm, case_file, tmp_path):
    """Workers are jobs, with what was asked for, and carry the runs."""
    study = Study(case_file, seeds=2, output=tmp_path / "s", settings={"run.steps": 30})
    options = {"walltime": "00:30:00", "queue": "short"}
    study.run(jobs=1, threads=2, cluster="slurm", options=options)
    assert study.ended
    script = (slurm / "job.sh").read_text()
    for line in ("-p short", "-t 00:30:00", "--cpus-per-task=2", "--mem=2G"):
        assert f"#SBATCH {line}" in script, script
    assert "--nthreads 1" in script


def test_clusters_that_are_not_there():
    with pytest.raises(CaseError, match=r"cluster = 'slrum': .*did you mean 'slurm'"):
        Cluster("slrum", 1)
    with pytest.raises(CaseError, match=r"cluster = 'slurm': .*walltim"):
        Cluster("slurm", 1, options={"walltim": "1"})
