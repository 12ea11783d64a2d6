"""Run the validation scripts, all or those named, and say which requirements were not met.

Usage: python validation/all.py [names...] [--short]

--short is a quick try of those that keep their runs: nothing is written to docs.
"""

from __future__ import annotations

import importlib
import sys

NAMES = (
    "viscosity_routes", "viscosity_rules", "lees_edwards_profile", "wall_slip", "thermostat",
    "conservation", "round_flows", "drag", "wakes", "solids_at_rest", "solids_inside",
    "bonded_modes", "viscoelastic", "polymer_diffusion", "colloids", "pooled_runs",
    "random_numbers", "demix", "flocks", "hard_spheres", "soft_spheres", "kinetic_monte_carlo",
    "contact_dynamics", "liquid", "freezing", "error_bars", "bodies",
    "bodies_in_flow", "bodies_more_flow", "bodies_slow_flow", "bodies_long_times",
)  # fmt: skip


def run(names: list[str]) -> int:
    """Run scripts by name; returns how many requirements were not met, 2 for a wrong name."""
    unknown = [name for name in names if name not in NAMES]
    if unknown:
        print(f"unknown: {', '.join(unknown)}; there are {', '.join(NAMES)}", file=sys.stderr)
        return 2
    missed = {}
    for name in names or NAMES:
        print(f"== {name}", flush=True)
        missed[name] = importlib.import_module(name).make()
    for name, number in missed.items():
        print(
            f"{name}: {'all met' if not number else f'{number} not met'}; docs/validation/{name}.md"
        )
    return 1 if any(missed.values()) else 0


if __name__ == "__main__":
    sys.exit(run([name for name in sys.argv[1:] if name != "--short"]))
