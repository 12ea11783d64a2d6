"""Where each transport coefficient comes from and how far it holds."""

from typing import NamedTuple

GOMPPER = "Gompper et al. 2009, Table 1"
NOGUCHI = "Noguchi and Gompper 2008"
DERIVED = "derived for mesokit, docs/theory.md"


class Origin(NamedTuple):
    """`source` with the number of the equation, and the `holds` range."""

    source: str
    holds: str


def origins(
    rule: str, dimension: int, angle_distribution: str = "fixed", thermostat: str = "none"
) -> dict[str, Origin]:
    """Source and range of every coefficient of `transport`, by the name of its field.

    Parameters as in `transport`. Equations in round brackets are those of docs/theory.md.

    >>> origins("srd", 3)["viscosity_collisional"].source
    'Gompper et al. 2009, Table 1; (3)'
    >>> origins("at+a", 2)["diffusion"].source
    'derived for mesokit, docs/theory.md (2), (4)'
    """
    angular, uniform = rule.endswith("+a"), angle_distribution == "uniform"
    held = rule.startswith("srd") and thermostat != "none"
    flat = "; 2D: fluctuations add to it, more in a larger box" if dimension == 2 else ""

    def source(equation: str, published: str = "") -> str:
        if angular:
            return f"{DERIVED} {equation}, (4)"
        if held or uniform:
            return f"{DERIVED} {equation}, " + ("(5)" if held else "r1 = r2 = 0")
        return f"{published}; {equation}" if published else f"{DERIVED} {equation}"

    published = GOMPPER if rule == "srd" else f"{NOGUCHI}, large M"
    full = "grid shift 1, M of 3 and more"
    short = "mean free path 1 and more; at 0.1 it is"
    once = "; one-step estimate, 1 to 13 % low at small angles" if held else ""
    isothermal = rule.startswith("at") or thermostat != "none"
    heat = Origin("", "energy is not conserved" if isothermal else "no formula")
    if rule == "srd" and not isothermal:
        heat = Origin(source("(7)", GOMPPER), full)
    return {
        "mean_free_path": Origin("definition, timestep sqrt(kT/m)", "always"),
        "viscosity": Origin("sum of both parts", f"{full}, within 1 to 7 %{flat}"),
        "viscosity_kinetic": Origin(
            source("(1)", published), f"{full}, {short} 10 to 20 % low, in 2D 20 to 70 %{once}"
        ),
        "viscosity_collisional": Origin(
            source("(3)", published),
            f"{full}, {short} 1 to 2 % high, in 2D with +a 10 %; at 0.02 up to 7 %",
        ),
        "dynamic_viscosity": Origin("definition, density m times kinematic", "as the viscosity"),
        "diffusion": Origin(source("(2)", published), f"{full}, {short} 10 to 18 % low{once}"),
        "schmidt": Origin("definition, viscosity / self-diffusion", "as both"),
        "thermal_diffusivity": heat,
        "sound_speed": Origin(
            "ideal gas, " + ("sqrt(kT/m)" if isothermal else "sqrt((d + 2)/d kT/m)"),
            "wave lengths of many cells",
        ),
        "sound_attenuation": Origin(
            f"{DERIVED} (9)" if isothermal else "linear hydrodynamics, (8)",
            f"{full}, long waves, amplitude exp(-G k^2 t/2){flat}",
        )
        if isothermal or not angular
        else heat,
    }
