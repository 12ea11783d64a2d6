"""Runs on a card: checkpoints across devices, too little memory, many particles, many steps."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest

from mesokit import SRD, Simulation
from mesokit.devices.cuda import Cuda
from mesokit.errors import RunError
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cuda.cost import memory_of
from mesokit.method.mpcd.engine.cuda.engine import CUDA
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.on_devices import pair
from tests.helpers.rank_runs import MESOKIT, same_files
from tests.helpers.small_fluids import make_case
from tests.on_card.test_bits import DRIVEN, WALLS

CASE = """
[run]
steps = 60
[box]
size = {size}
[fluid]
density = 5
timestep = 0.4
thermostat = {{ rule = "maxwell-boltzmann" }}
force = {{ rule = "uniform", acceleration = [0.05, 0, 0] }}
[[wall]]
shape = "plates"
axis = "y"
[[observe]]
quantity = "velocity-profile"
axis = "y"
every = 3
[trajectory]
every = 20
[log]
every = 10
"""
LENGTH = 464  # cells, for a thousand million particles
KEPT_FREE = 0.9  # of the memory that is free
SMALL = 8  # cells of a rehearsal


@pytest.fixture
def case(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(CASE.format(size=[8, 9, 7]))
    return file


def test_a_run_goes_from_processor_to_card_and_back(case, tmp_path, name) -> None:
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    Simulation(case, output=whole, threads=1).run()
    first = Simulation(case, output=parts, threads=1)
    first.run(13)
    first.checkpoint()
    second = Simulation.resume(parts, device=name)
    second.run(30)
    second.checkpoint()
    del first, second
    Simulation.resume(parts, threads=1).run()
    same_files(whole, parts)


def test_too_little_memory_is_an_error_of_one_line_before_the_run(card, tmp_path, name) -> None:
    if not isinstance(card, Cuda):
        pytest.skip("the memory of a card")
    file = tmp_path / "large.toml"
    file.write_text(CASE.format(size=[1500, 1500, 1500]))
    command = [*MESOKIT, "run", file.name, "--device", name, "--quiet"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0
    assert "out of memory" in done.stderr
    assert done.stderr.strip().count("\n") == 0


def test_after_too_much_was_asked_a_card_goes_on(card) -> None:
    if not isinstance(card, Cuda):
        pytest.skip("the memory of a card")
    free, total = card.memory
    with pytest.raises(RunError, match="out of memory"):
        card.allocate(2 * total)
    assert card.memory == (free, total)


def length_that_fits(card) -> int:
    """Cells along each axis of a box for a thousand million particles, or for what fits."""
    if not isinstance(card, Cuda):
        return SMALL
    each = memory_of(Numbers(make_case(size=(SMALL,) * 3, collision=SRD(angle=130.0)))) / SMALL**3
    return min(LENGTH, int((KEPT_FREE * card.memory[0] / each) ** (1 / 3)))


@pytest.mark.long
def test_as_many_particles_as_fit_keep_momentum_and_energy(card) -> None:
    size = (length_that_fits(card),) * 3
    fluid = CUDA(make_case(size=size, density=10, timestep=0.1, collision=SRD(angle=130.0)), card)
    start(fluid)
    number, momentum, energy = fluid.totals()
    fluid.advance(5)
    after = fluid.totals()
    assert number == after[0] == 10 * np.prod(size)
    np.testing.assert_allclose(after[1], momentum, rtol=0, atol=1e-9 * fluid.n)
    np.testing.assert_allclose(after[2], energy, rtol=1e-9)


@pytest.mark.long
def test_many_steps_have_the_same_bits(card) -> None:
    both = pair(card, ("walls",), size=(6, 8, 6), **(DRIVEN | WALLS["plates"]))
    both.advance(50_000)
    both.require_same()
