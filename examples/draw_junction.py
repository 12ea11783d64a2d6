"""Draw junction.png: a channel that splits into a wide and a narrow branch, which meet again."""

from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage

PIXELS = 8  # a cell
SIZE = 120, 48  # cells
WIDE, NARROW, CHANNEL = 12, 7, 16  # widths of the branches and of the channel, in cells

x, y = ((np.arange(n * PIXELS) + 0.5) / PIXELS for n in SIZE)
part = (np.tanh((x - 34) / 6) - np.tanh((x - 86) / 6)) / 2  # how far the branches are apart
top, bottom = 24 + CHANNEL / 2, 24 - CHANNEL / 2
upper = np.abs(y[:, None] - (top - WIDE / 2 + 10 * part)) < WIDE / 2
lower = np.abs(y[:, None] - (bottom + NARROW / 2 - 12 * part)) < NARROW / 2
trunk = (np.abs(y[:, None] - 24) < CHANNEL / 2) & ((x < 28) | (x > 92))
fluid = ndimage.gaussian_filter((upper | lower | trunk).astype(float), 6, mode="wrap") > 0.5
image = Image.fromarray((255 * fluid[::-1]).astype(np.uint8))
image.convert("1").save(Path(__file__).with_name("junction.png"), optimize=True)
