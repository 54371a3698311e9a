# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two pictures alike as an eye sees them: same_picture.py FOUND WANTED. Versions of a program draw edges and texts
differently."""
import sys

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
tiles = 20  # along each side; a tile's mean colour does not see where a line runs


def means(path):
    """Mean colours of tiles x tiles parts of a picture, 0 to 255."""
    picture = gdal.Open(path).ReadAsArray()[:3].astype(float)
    _, rows, columns = picture.shape
    cut = picture[:, : rows - rows % tiles, : columns - columns % tiles]
    return cut.reshape(3, tiles, rows // tiles, tiles, columns // tiles).mean(axis=(2, 4))


def same_picture(found, wanted, largest=50, mean=5):
    """Stops where a tile's mean colour differs by more than `largest`, or all tiles' by `mean`. Sizes may differ."""
    a, b = means(found), means(wanted)
    if a.std() < 10:
        raise SystemExit(f"FAILED {found} is blank")
    worst, all_over = np.abs(a - b).max(), np.abs(a - b).mean()
    words = f"{found}: as {wanted}, tiles differ by {worst:.1f} at most, {all_over:.2f} on average (of 255)"
    if worst > largest or all_over > mean:
        raise SystemExit(f"FAILED {words}; look at both")
    return words


print(same_picture(*sys.argv[1:]))
