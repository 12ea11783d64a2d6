"""Deviation of the velocities of a granular gas from Maxwell's."""


def fourth_cumulant(restitution: float, dimension: int, heated: bool = False) -> float:
    """a_2 = d/(d + 2) <v^4>/<v^2>^2 - 1 of smooth inelastic spheres, 0 of Maxwell's.

    To first order in a_2 in a dilute uniform gas: cooling freely, or held by random kicks (van
    Noije and Ernst 1998).

    Parameters: `restitution` coefficient e, constant; `dimension` 2 or 3; `heated` whether random
    kicks (white noise) give back what collisions take.

    >>> round(fourth_cumulant(0.5, 3), 5), round(fourth_cumulant(0.5, 3, heated=True), 5)
    (0.05246, 0.0256)
    >>> round(fourth_cumulant(0.9, 2), 5)
    -0.02686
    """
    e, d = restitution, dimension
    above = 16 * (1 - e) * (1 - 2 * e**2)
    if heated:
        return above / (73 + 56 * d - 3 * (35 + 8 * d) * e + 30 * (1 - e) * e**2)
    return above / (9 + 24 * d + (8 * d - 41) * e + 30 * (1 - e) * e**2)
