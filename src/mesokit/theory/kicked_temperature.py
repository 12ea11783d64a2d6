"""The temperature of inelastic hard spheres that are kicked at random."""


def kicked_temperature(power: float, restitution: float, unit_rate: float) -> float:
    """Thermal energy at which kicks give as much as collisions take, in molecular chaos.

    A sphere loses (1 - e^2) kT/2 in each of its collisions (van Noije and Ernst 1998, to lowest
    order in the fourth cumulant). Kicks feed flows on long
    waves, which collisions damp slowly (van Noije, Ernst, Trizac and Pagonabarraga 1999): what
    spheres move together counts as temperature and is not lost in collisions. At e = 0.8 and a
    packing fraction of 0.2 some 400 disks are 5 % hotter than this, 1,600 are 6 %, 25 are 1 %.

    Parameters: `power` energy that a sphere gets per time; `restitution` coefficient e of smooth
    spheres, below 1; `unit_rate` collisions of a sphere per time at kT = 1, such as `enskog_rate`
    gives.

    >>> round(kicked_temperature(0.0627, 0.95, 1.2871), 4)
    0.9995
    """
    return (2 * power / ((1 - restitution**2) * unit_rate)) ** (2 / 3)
