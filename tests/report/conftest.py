"""The folder of a small run, made without running."""

from __future__ import annotations

import pytest

from mesokit import (
    Box,
    Case,
    Conservation,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Uniform,
    VelocityField,
    VelocityProfile,
)
from mesokit.io import h5md
from mesokit.io.provenance import provenance
from mesokit.io.run_directory import RunDirectory
from tests.helpers.fake_fluid import FakeFluid

FLUID = Fluid(density=5, force=Uniform([0.01, 0.0]), thermostat=MaxwellBoltzmann())
OBSERVE = (Conservation(every=5), VelocityProfile(), VelocityField())
TITLE = 'Slit <script>alert("1")</script> & more'


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory):
    """`run_folder(ended)` is the folder of a run in a slit, as a run leaves it."""

    def make(ended):
        folder = tmp_path_factory.mktemp("report") / "slit"
        parts = {"walls": [Plates("y")], "observe": OBSERVE, "title": TITLE}
        case = Case(run=Run(steps=60), box=Box([6, 8]), fluid=FLUID, **parts)
        directory, fluid = RunDirectory.create(folder, case), FakeFluid(case)
        accumulators = [observable.accumulator(case) for observable in case.observe]
        while fluid.step < 60:
            fluid.advance(10)
            for accumulator in accumulators:
                accumulator.observe(fluid)
        record = provenance(case, threads=1)
        if ended:
            record |= {"ended": "2020-02-02T02:02:02+00:00", "timings": {"sweep": 3.0, "sort": 1.0}}
            results = [accumulator.result() for accumulator in accumulators]
            h5md.write(directory.data_file, case, record, results, None)
        directory.write_provenance(record)
        return folder

    return make
