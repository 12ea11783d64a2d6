"""The lattice gas of `benchmarks.kinetic_monte_carlo` as a model of kmcos, compiled.

Python of an environment with kmcos runs it: PYTHON model.py FOLDER
"""

import os
import sys
from pathlib import Path

import numpy as np
from kmcos.cli import main as export
from kmcos.types import Action, Condition, Layer, Parameter, Process, Project, Site, Species

AROUND = {"right": "(1,0,0)", "left": "(-1,0,0)", "up": "(0,1,0)", "down": "(0,-1,0)"}


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    os.chdir(folder)
    project = Project()
    project.set_meta(author="mesokit", email="none@none", model_name="gas", model_dimension=2)
    for name in ("empty", "A"):
        project.add_species(Species(name=name))
    layer = Layer(name="square")
    layer.add_site(Site(name="a", pos="0.5 0.5 0.5", default_species="empty"))
    project.add_layer(layer)
    project.lattice.cell = np.diag([1.0, 1.0, 1.0])
    project.add_parameter(Parameter(name="k", value=1.0))

    def add(name: str, *changes: tuple[str, str, str]) -> None:
        places = [
            (project.lattice.generate_coord(f"a.{where}.square"), *turn) for where, *turn in changes
        ]
        project.add_process(
            Process(
                name=name,
                rate_constant="k",
                condition_list=[Condition(coord=at, species=before) for at, before, _ in places],
                action_list=[Action(coord=at, species=after) for at, _, after in places],
            )
        )

    add("adsorb", ("(0,0,0)", "empty", "A"))
    add("desorb", ("(0,0,0)", "A", "empty"))
    for name, where in AROUND.items():
        add(f"hop_{name}", ("(0,0,0)", "A", "empty"), (where, "empty", "A"))
    project.filename = "gas.xml"
    project.save()
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    export("export gas.xml out")


if __name__ == "__main__":
    main()
