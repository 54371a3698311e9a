# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two pictures alike as an eye sees them: versions of a program draw edges and texts differently."""
import numpy as np
from osgeo import gdal

gdal.UseExceptions()
tiles = 24  # along each side; a tile's mean colour does not see where a line runs


def means(path):
    """Mean colours of tiles x tiles parts of a picture, 0 to 255."""
    picture = gdal.Open(path).ReadAsArray()[:3].astype(float)
    _, rows, columns = picture.shape
    cut = picture[:, : rows - rows % tiles, : columns - columns % tiles]
    return cut.reshape(3, tiles, rows // tiles, tiles, columns // tiles).mean(axis=(2, 4)), (rows, columns)


def same_picture(found, wanted, largest=40, mean=4):
    """Stops where pictures differ in size, in a tile's mean colour by more than `largest`, in all by more than `mean`."""
    (a, size_a), (b, size_b) = means(found), means(wanted)
    if size_a != size_b:
        raise SystemExit(f"FAILED {found} is {size_a}, {wanted} {size_b} pixels")
    if a.std() < 10:
        raise SystemExit(f"FAILED {found} is blank")
    worst, all_over = np.abs(a - b).max(), np.abs(a - b).mean()
    words = f"{found}: as {wanted}, tiles differ by {worst:.1f} at most, {all_over:.2f} on average (of 255)"
    if worst > largest or all_over > mean:
        raise SystemExit(f"FAILED {words}; look at both")
    return words
