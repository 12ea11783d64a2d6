"""Kill one rank of a run after another, at random moments, and look at what is left.

Usage: python benchmarks/killed_ranks.py [kills] [ranks]

One run on several ranks is killed so many times (20 unless said), each time one rank by SIGKILL,
and goes on from its last checkpoint, the last time to its end. Said are the seconds until no rank
was left, and what the user was told. At the end the files must be those of a run on one rank.
"""

from __future__ import annotations

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import h5py
import numpy as np

CASE = """
[run]
steps = 150000
checkpoint_every = 200
[box]
size = [12, 10]
[fluid]
density = 5
[[observe]]
quantity = "conservation"
every = 100
[trajectory]
every = 1000
[log]
every = 1000
"""
MESOKIT = [sys.executable, "-m", "mesokit", "--import", "notes"]
NOTES = """
import os
if "PMI_RANK" in os.environ:
    with open("pid-" + os.environ["PMI_RANK"], "w") as file:
        file.write(str(os.getpid()))
"""
TOLD = r"mesokit: rank {} ended by SIGKILL(; .*: mesokit resume out --ranks \d+)?"


def start(words: list[str], folder: Path) -> subprocess.Popen[str]:
    path = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
    return subprocess.Popen(
        [*MESOKIT, *words],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def pids(folder: Path) -> dict[int, int]:
    """The process of each rank that has begun."""
    found = {}
    for file in folder.glob("pid-*"):
        if text := file.read_text():
            found[int(file.name[4:])] = int(text)
    return found


def alive(process: int) -> bool:
    try:
        return "Z" not in Path(f"/proc/{process}/stat").read_text().rpartition(")")[2][:3]
    except OSError:
        return False


def kill_one(
    folder: Path, ranks: int, words: list[str], draw: random.Random, longest: float
) -> Any:
    """Start, and kill a rank after a random time: who it was, seconds until all had ended, whether
    it was told as it should be, status and lines; None if the run came to its end before."""
    for file in folder.glob("pid-*"):
        file.unlink()
    process = start(words, folder)
    moment = time.monotonic() + draw.uniform(0, longest)
    victim = draw.randrange(ranks)
    while time.monotonic() < moment or victim not in pids(folder):
        if process.poll() is not None:
            return None
        time.sleep(0.002)
    own = pids(folder)
    began = time.monotonic()
    try:
        os.kill(own[victim], signal.SIGKILL)
    except ProcessLookupError:  # it has just ended by itself, and must have done so in order
        _, said = process.communicate()
        if process.returncode:
            raise RuntimeError(f"status {process.returncode} without a kill: {said}") from None
        return None
    _, said = process.communicate()
    while any(alive(p) for p in pids(folder).values()):
        time.sleep(0.002)
    seconds = time.monotonic() - began
    lines = [line for line in said.splitlines() if line.startswith("mesokit: ")]
    told = len(lines) == 1 and re.fullmatch(TOLD.format(victim), lines[0]) is not None
    told = told and "BAD TERMINATION" not in said
    return victim, seconds, told, process.returncode, lines


def same(one: Path, two: Path) -> bool:
    """Whether two runs have written the same."""
    with np.load(one / "checkpoint.npz") as a, np.load(two / "checkpoint.npz") as b:
        equal = all(np.array_equal(a[name], b[name]) for name in set(a.files) - {"meta"})
    equal &= contents(one) == contents(two) != {}
    return equal and (one / "log.csv").read_text() == (two / "log.csv").read_text()


def contents(run: Path) -> dict[str, bytes]:
    """Frames and results."""
    found = {}

    def add(name: str, item: h5py.Dataset | h5py.Group) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype != object:  # but texts
            found[name] = np.asarray(item[()]).tobytes()

    with h5py.File(run / "run.h5") as file:
        file.visititems(add)
    return found


def main(kills: int = 20, ranks: int = 2) -> int:
    draw, failed, times, ends = random.Random(1), 0, [], []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_text(CASE)
        (folder / "notes.py").write_text(NOTES)
        began = time.monotonic()
        start(["run", "case.toml", "--output", "one", "--quiet"], folder).communicate()
        first = ["run", "case.toml", "--output", "out", "--overwrite"]
        on = ["--ranks", str(ranks), "--quiet"]
        longest = 1.5 * min(time.monotonic() - began, 12.0)
        while len(times) < kills:
            begun = (folder / "out" / "case.toml").exists()
            words = [*(["resume", "out"] if begun else first), *on]
            found = kill_one(folder, ranks, words, draw, longest)
            if found is None:
                ends.append(same(folder / "one", folder / "out"))
                print(f"it had ended before, the same: {ends[-1]}; anew", flush=True)
                shutil.rmtree(folder / "out")
                continue
            victim, seconds, told, status, lines = found
            times.append(seconds)
            failed += not told or status != 128 + signal.SIGKILL
            print(f"{len(times):3} rank {victim}: {seconds:.2f} s, {status}, {lines}", flush=True)
        start(["resume", "out", *on], folder).communicate()
        ends.append(same(folder / "one", folder / "out"))
    print(f"{kills} kills of a rank of {ranks}: {failed} not told as they should be")
    print(f"seconds until all ended: median {sorted(times)[kills // 2]:.2f}, most {max(times):.2f}")
    print(f"the same files as on one rank: {sum(ends)} of {len(ends)} runs that ended")
    return failed + len(ends) - sum(ends)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
