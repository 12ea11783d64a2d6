"""A dilute gas by soft spheres and by event-driven dynamics: same collisions, same pressure.

python dilute_gas.py     prints a table beside theory; some minutes, nearly all of soft spheres
"""

import math
import sys
import time

import numpy as np

from mesokit import Box, Case, HardSpheres, Run, Simulation, SoftSpheres, SpringDashpot, theory
from mesokit.method.spheres.common.kinds import ball_volume

SHORT = "--short" in sys.argv  # a quick try
FRACTIONS = {2: 1.11e-3, 3: 4.7e-4}  # where the mean free path is 500 radii
GRAINS, CONTACT_TIME, BLOCKS = 1000, 0.01, 10
LOOKS = 500 if SHORT else 20_000  # at soft spheres in each block, a contact time apart
FLIGHTS = 20 if SHORT else 200  # steps of event-driven dynamics in each block
SPEEDS = 20  # how often in a block one looks at speeds


def soft_blocks(engine):
    """Collisions of a sphere per time, P/(n kT) - 1 and the mean speed, of each block.

    A contact lasts its contact time: looked at that often, each collision is seen once.
    """
    every = round(CONTACT_TIME / engine.timestep)
    volume = float(np.prod(engine.box))
    engine.advance(100 * every)
    for _ in range(BLOCKS):
        touching, pushed, speeds = 0, 0.0, []
        for look in range(LOOKS):
            engine.advance(every)
            seen = int(engine.coordination().sum())
            touching += seen
            pushed += -np.trace(engine.stress["pair"]) if seen else 0.0
            if look % (LOOKS // SPEEDS) == 0:
                speeds.append(mean_speed(engine))
        rate = touching / engine.n / (LOOKS * every * engine.timestep)
        yield rate, pushed / LOOKS * volume / (2 * engine.totals()[2]), np.mean(speeds)


def hard_blocks(engine):
    """The same of hard spheres, which count."""
    engine.advance(FLIGHTS)
    for _ in range(BLOCKS):
        before, virial, begun, speeds = engine.collisions[0], engine.virial, engine.time, []
        for _ in range(SPEEDS):
            engine.advance(FLIGHTS // SPEEDS)
            speeds.append(mean_speed(engine))
        took = engine.time - begun
        rate = 2 * (engine.collisions[0] - before) / engine.n / took
        pressure = (engine.virial - virial) / took / (2 * engine.totals()[2])
        yield rate, pressure, np.mean(speeds)


def mean_speed(engine):
    """At this moment."""
    return float(np.linalg.norm(engine.velocities(), axis=1).mean())


def main():
    """Run both gases by both methods."""
    print("| gas | collisions per time | P/(n kT) - 1 | free path, radii | s |")
    print("|---|---|---|---|---|")
    for d, fraction in FRACTIONS.items():
        box = Box([(GRAINS * ball_volume(d, 1.0) / fraction) ** (1 / d)] * d)
        pair = SpringDashpot(restitution=1, contact_time=CONTACT_TIME)
        soft = SoftSpheres(number=GRAINS, pair=pair)
        hard = HardSpheres(number=GRAINS, timestep=100.0)
        for method, spheres, blocks in (
            ("soft-spheres", soft, soft_blocks),
            ("event-driven", hard, hard_blocks),
        ):
            case = Case(run=Run(0, method=method), box=box, spheres=spheres)
            engine = Simulation(case, threads=1).engine
            begun = time.process_time()
            each = np.array(list(blocks(engine)))
            took = time.process_time() - begun
            each[:, 2] *= 2 / each[:, 0]  # free path in radii
            mean, error = each.mean(axis=0), each.std(axis=0, ddof=1) / math.sqrt(BLOCKS)
            cells = [f"{m:.4g} +- {e:.2g}" for m, e in zip(mean, error, strict=True)]
            print(f"| {d}D, {method} | {' | '.join(cells)} | {took:.3g} |", flush=True)
        excess = theory.compressibility(fraction, d) - 1
        rate = 2 * d * excess / math.sqrt(math.pi)
        path = 2 * math.sqrt(math.pi / 2 if d == 2 else 8 / math.pi) / rate
        print(f"| {d}D, theory | {rate:.4g} | {excess:.4g} | {path:.4g} | |", flush=True)


if __name__ == "__main__":
    main()
