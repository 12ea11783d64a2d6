"""Averages over one collision cell that the angular-momentum-conserving rules (+a) need.

A +a collision with N particles at positions x (uniform in a unit cell) is the linear map
v' = P v + (1 - P) R v: P projects on rigid motion (translation and rotation of the cell) and R
turns every velocity alike, or draws fresh ones (AT). All that transport needs of P are

    s0(N) = 1/N + <tr(I^-1 K I^-1 K)> / (2 N)   share of the shear stress that P keeps
    q(N)  = <S_yy - c.I^-1.c>                    momentum moved across the cell by a shear flow
    l(N)  = <S_xx - b.I^-1.b>                    the same for a compressing flow

with S = sum x x^T about the centre of mass, I = tr(S) - S (its pseudo-inverse for two particles
in 3D), K_rs = sum (e_r x x).e.(e_s x x) for the stress e = xy + yx, and
c_r, b_r = sum (e_r x x)_x y and (e_r x x)_x x. Derived for mesokit; the tables below are means
over random positions.
`python -m mesokit.theory.srd_angular_table` prints them again (four minutes).
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SAMPLES = 400_000
SEED = 20090
LAST = 32  # largest tabulated N; beyond, an expansion in 1/N continues the table
# Rows: N s0, 24 q, 12 l for N = 2 .. 32. Standard errors: at most 0.0003, 0.0011 and 0.0012.
# fmt: off
_TABLE = {
    2: (
        (  # N s0
            1.2516, 1.1746, 1.1329, 1.1066, 1.0888, 1.0756, 1.0661, 1.0585, 1.0524, 1.0476, 1.0435,
            1.0400, 1.0372, 1.0345, 1.0322, 1.0303, 1.0286, 1.0271, 1.0257, 1.0245, 1.0233, 1.0223,
            1.0213, 1.0205, 1.0197, 1.0189, 1.0182, 1.0176, 1.0170, 1.0164, 1.0160,
        ),
        (  # 24 q
            0.5390, 1.4662, 2.4671, 3.4808, 4.4943, 5.5085, 6.5191, 7.5266, 8.5349, 9.5411,
            10.5443, 11.5505, 12.5524, 13.5538, 14.5592, 15.5618, 16.5636, 17.5657, 18.5671,
            19.5700, 20.5707, 21.5727, 22.5700, 23.5722, 24.5753, 25.5752, 26.5775, 27.5755,
            28.5779, 29.5784, 30.5797,
        ),
        (  # 12 l
            0.7306, 1.6331, 2.5888, 3.5657, 4.5506, 5.5416, 6.5342, 7.5298, 8.5266, 9.5228,
            10.5201, 11.5196, 12.5160, 13.5161, 14.5154, 15.5142, 16.5141, 17.5125, 18.5115,
            19.5101, 20.5105, 21.5099, 22.5090, 23.5089, 24.5081, 25.5089, 26.5082, 27.5063,
            28.5065, 29.5079, 30.5044,
        ),
    ),
    3: (
        (  # N s0
            1.4688, 1.5588, 1.4835, 1.4368, 1.4053, 1.3823, 1.3648, 1.3518, 1.3412, 1.3327, 1.3254,
            1.3193, 1.3143, 1.3098, 1.3060, 1.3025, 1.2995, 1.2968, 1.2944, 1.2923, 1.2903, 1.2885,
            1.2869, 1.2854, 1.2840, 1.2826, 1.2815, 1.2805, 1.2793, 1.2784, 1.2775,
        ),
        (  # 24 q
            0.4277, 1.1953, 2.1189, 3.0903, 4.0773, 5.0742, 6.0751, 7.0736, 8.0748, 9.0728,
            10.0748, 11.0784, 12.0787, 13.0799, 14.0804, 15.0817, 16.0821, 17.0829, 18.0847,
            19.0845, 20.0841, 21.0849, 22.0870, 23.0858, 24.0861, 25.0871, 26.0875, 27.0874,
            28.0875, 29.0905, 30.0895,
        ),
        (  # 12 l
            0.5714, 1.3432, 2.2390, 3.1804, 4.1417, 5.1179, 6.1028, 7.0873, 8.0778, 9.0672,
            10.0627, 11.0584, 12.0519, 13.0485, 14.0455, 15.0430, 16.0402, 17.0393, 18.0363,
            19.0349, 20.0316, 21.0303, 22.0291, 23.0272, 24.0274, 25.0279, 26.0251, 27.0217,
            28.0237, 29.0219, 30.0218,
        ),
    ),
}
# fmt: on
# N s0 = a + b/N + c/N^2, 24 q = N + a + b/N, 12 l = N + a + b/N for larger N. The a are
# exact (expansion about S = N/12); the other coefficients fit N = 20 .. 32.
_TAIL = {
    2: ((1.0, 0.5, 0.3), (-1.4, -0.65, 0.0), (-1.5, 0.2, 0.0)),
    3: ((1.25, 0.865, 0.47), (-1.9, -0.32, 0.0), (-2.0, 0.7, 0.0)),
}


def rigid_share(dimension: int, particles: Array) -> Array:
    """Fraction of the velocity components that translation and rotation of a cell hold: tr P / dN.

    3/(2N) in 2D; in 3D 2/N, but 5/6 for two particles (no rotation about their axis); 1 for one.

    >>> rigid_share(3, np.array([1.0, 2.0, 10.0])).round(4).tolist()
    [1.0, 0.8333, 0.2]
    """
    rigid = np.where(particles == 1, 2, 3) if dimension == 2 else np.full(particles.shape, 6)
    if dimension == 3:
        rigid = np.where(particles == 1, 3, np.where(particles == 2, 5, rigid))
    return rigid / (dimension * particles)


def cell_table(dimension: int, particles: Array) -> tuple[Array, Array, Array]:
    """s0, q and l of the module's first lines for arrays of cell occupancies N >= 1.

    >>> s0, q, l = cell_table(2, np.array([1.0, 10.0, 1000.0]))
    >>> s0.round(5).tolist(), (24 * q).round(2).tolist()
    ([1.0, 0.10524, 0.001], [0.0, 8.53, 998.6])
    """
    n = np.asarray(particles, dtype=float)
    inside = np.clip(n, 2, LAST).astype(int) - 2
    columns = []
    for row, (a, b, c) in enumerate(_TAIL[dimension]):
        tail = (n if row else 0.0) + a + b / n + c / n**2
        columns.append(np.where(n <= LAST, np.array(_TABLE[dimension][row])[inside], tail))
    one = n == 1
    return (
        np.where(one, 1.0, columns[0] / n),
        np.where(one, 0.0, columns[1] / 24),
        np.where(one, 0.0, columns[2] / 12),
    )


def shear_coefficients(dimension: int, particles: Array) -> tuple[Array, Array, Array]:
    """s0, s1, s2 of one SRD+a collision: it multiplies sum v_x v_y by s0 + s1 cos a + s2 cos 2a.

    Exact for the map P v + (1 - P) R v: with rig = rigid_share and k the kept share of
    `cell_table`, the factor is k + 2 r1 (rig - k) + r2 (1 - 2 rig + k), where r1 and r2 are the
    means of R on vectors and on traceless tensors. The rescaling that restores the energy of a
    cell changes it at order 1/N^2.

    >>> [round(float(s), 4) for s in shear_coefficients(2, np.array(10.0))]
    [0.1052, 0.0895, 0.8052]
    """
    kept = cell_table(dimension, particles)[0]
    cross = 2 * (rigid_share(dimension, np.asarray(particles)) - kept)
    rest = 1 - cross - kept
    if dimension == 2:
        return kept, cross, rest
    return kept + cross / 3 + rest / 5, 2 / 3 * cross + 2 / 5 * rest, 2 / 5 * rest


def cell_averages(dimension: int, particles: int, samples: int, seed: int = SEED) -> Array:
    """Monte-Carlo means and standard errors of N s0, 24 q and 12 l: array of shape (2, 3)."""
    rng = np.random.default_rng((seed, dimension, particles))
    blocks = []
    for start in range(0, samples, 20_000):
        size = min(20_000, samples - start)
        x = rng.random((size, particles, dimension))
        x -= x.mean(axis=1, keepdims=True)
        blocks.append(_one_block(np.matmul(x.transpose(0, 2, 1), x), particles))
    values = np.concatenate(blocks)
    return np.array([values.mean(axis=0), values.std(axis=0) / np.sqrt(samples)])


def _one_block(inner: Array, particles: int) -> Array:
    """N s0, 24 q and 12 l of each sample, averaged over the axes of the cell."""
    dimension = inner.shape[-1]
    eps = _levi_civita(dimension)
    trace = np.trace(inner, axis1=1, axis2=2)
    # inertia_rs = sum_i (e_r x x_i).(e_s x x_i)
    inertia = np.einsum("arb,asd,nbd->nrs", eps, eps, inner)
    singular = dimension == 3 and particles == 2
    inverse = np.linalg.pinv(inertia, hermitian=True) if singular else np.linalg.inv(inertia)
    kept: list[Array] = []
    shear: list[Array] = []
    along: list[Array] = []
    # All axes of a cell are alike, so the terms of all pairs of axes i, j are averaged. Shear (i !=
    # j) gives q, compression (i = j) gives l, each pair once gives s0.
    for i in range(dimension):
        for j in range(dimension):
            # flow along i that grows along j: what is left of it after the rigid rotation
            spin = np.einsum("rb,nb->nr", eps[i], inner[:, :, j])
            rest = inner[:, j, j] - np.einsum("nr,nrs,ns->n", spin, inverse, spin)
            (along if i == j else shear).append(rest)
            if i < j:
                e = np.zeros((dimension, dimension))
                e[i, j] = e[j, i] = 1.0
                part = inverse @ np.einsum("arb,ac,csd,nbd->nrs", eps, e, eps, inner)
                kept.append(1.0 + np.einsum("nrs,nsr->n", part, part) / 2)
    # <tr S> is known exactly: using it as a control variate removes most of the noise of q and l
    noise = trace / dimension - (particles - 1) / 12
    moved, pressed = np.mean(shear, axis=0) - noise / 2, np.mean(along, axis=0) - noise
    return np.stack([np.mean(kept, axis=0), 24 * moved, 12 * pressed], axis=1)


def _levi_civita(dimension: int) -> Array:
    """eps[a, r, b]: component a of (rotation axis r) x (unit vector b)."""
    if dimension == 2:
        return np.array([[[0.0, -1.0]], [[1.0, 0.0]]])
    eps = np.zeros((3, 3, 3))
    for r in range(3):
        eps[(r + 2) % 3, r, (r + 1) % 3] = 1.0
        eps[(r + 1) % 3, r, (r + 2) % 3] = -1.0
    return eps


def main() -> None:
    """Print the tables and the largest standard error of each column."""
    for dimension in (2, 3):
        rows = [cell_averages(dimension, n, SAMPLES) for n in range(2, LAST + 1)]
        for n, (mean, _) in enumerate(rows, start=2):
            print(dimension, n, *(f"{value:.5f}" for value in mean))
        print("largest standard errors", np.max([error for _, error in rows], axis=0))


if __name__ == "__main__":
    main()
