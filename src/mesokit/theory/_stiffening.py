"""The cubic equation of springs that are made stiffer in shear."""


def stiffening(drive: float) -> float:
    """The root x >= 1 of x^2 (x - 1) = drive, for a drive of 0 or more."""
    x = 1 + drive ** (1 / 3)  # above the root, from where Newton's steps only fall
    for _ in range(100):
        step = (x * x * (x - 1) - drive) / (x * (3 * x - 2))
        x -= step
        if step <= 1e-15 * x:
            break
    return float(max(x, 1.0))
