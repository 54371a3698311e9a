# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far two runs differ."""
import dataclasses
import math

import numpy

from talus.errors import TalusError
from talus.results import Run, open_run


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Two runs in numbers; the second is brought to the first one's cells by area, which keeps its volume."""

    threshold_m: float  #: what counts as covered
    elsewhere: float  #: share of the first deposit that lies elsewhere in the second [-]
    footprint_csi: float  #: area of both footprints over that of either, by peak thickness [-]; 1: the same
    deposit_csi: float  #: the same of the deposits [-]
    runout_first_m: float  #: in plan, from the crown straight to the farthest deposit
    runout_second_m: float
    runout_difference_m: float  #: second less first
    volume_first_m3: float  #: on the deposit map
    volume_second_m3: float
    rms_m: float  #: difference of thickness over where either deposit is thicker than the threshold


def compare(first, second, threshold_m=None):
    """Compares two runs (Run, or their folders) and returns a Comparison.

    `elsewhere` is half the sum of |a - b| over the sum of b, where b is the first run's deposit and a the second one's,
    scaled to the volume of b: as `talus compare` has it. Run-out as in score.json: L from the highest cell of the
    release. threshold_m [m] is that of footprint and deposit in `[postprocess]`; None: the first run's own. Raises
    TalusError where the coordinate systems differ, or there is no deposit.
    """
    first, second = (one if isinstance(one, Run) else open_run(one) for one in (first, second))
    if first.crs_wkt != second.crs_wkt:
        raise TalusError(f"{first.file} and {second.file}: their coordinate systems differ; run both in the same one")
    a, b = second.maps(), first.maps()
    threshold_m = b.attrs["threshold_m"] if threshold_m is None else threshold_m
    target = _grid_over(b, a)
    volumes = {name: (_volume_on(target, a[name]), _volume_on(target, b[name]))
               for name in ("deposit_thickness", "peak_thickness")}
    area = b.deposit_thickness.cell_m ** 2
    left, right = volumes["deposit_thickness"]
    if not (left.sum() > 0 and right.sum() > 0):
        raise TalusError(f"{first.file} and {second.file}: one of them has no deposit, so there is nothing to compare")
    either = (left > threshold_m * area) | (right > threshold_m * area)
    runouts = [runout(maps, threshold_m) for maps in (b, a)]
    return Comparison(
        threshold_m=threshold_m,
        elsewhere=float(0.5 * numpy.abs(left * (right.sum() / left.sum()) - right).sum() / right.sum()),
        footprint_csi=_csi(*volumes["peak_thickness"], threshold_m * area),
        deposit_csi=_csi(left, right, threshold_m * area),
        runout_first_m=runouts[0], runout_second_m=runouts[1], runout_difference_m=runouts[1] - runouts[0],
        volume_first_m3=math.fsum(right.flat), volume_second_m3=math.fsum(left.flat),
        rms_m=float(numpy.sqrt(numpy.mean(((left - right)[either] / area) ** 2))) if either.any() else 0.0,
    )  # fmt: skip


def runout(maps, threshold_m=None):
    """L [m], in plan from the crown (highest cell of the release) to the farthest deposit thicker than the threshold;
    None: than the run's own. NaN without release or deposit."""
    threshold_m = maps.attrs["threshold_m"] if threshold_m is None else threshold_m
    release, before = maps.initial_thickness.values, maps.before.values
    deposit = numpy.nan_to_num(maps.deposit_thickness.values)
    x, y = numpy.meshgrid(maps.x.values, maps.y.values)
    thickest = numpy.nan_to_num(release).max()
    held = (numpy.nan_to_num(release) > min(threshold_m, 0.1 * thickest)) & numpy.isfinite(before)
    if not held.any() or not (deposit > threshold_m).any():
        return math.nan
    highest = held & (before >= before[held].max() - 1e-3)  # 1 mm: the same height
    middle = numpy.hypot(x - x[highest].mean(), y - y[highest].mean())
    crown = numpy.flatnonzero(highest)[middle[highest].argmin()]
    return float(numpy.hypot(x - x.flat[crown], y - y.flat[crown])[deposit > threshold_m].max())


def _csi(left, right, limit):
    both, either = ((left > limit) & (right > limit)).sum(), ((left > limit) | (right > limit)).sum()
    return float(both / either) if either else 1.0


def _grid_over(own, other):
    """Edges x, y of own's cells, carried on until they hold the other's map too."""
    edges = []
    for axis in ("x", "y"):
        cell = own.deposit_thickness.cell_m
        low, high = float(own[axis][0]) - cell / 2, float(own[axis][-1]) + cell / 2
        half = other.deposit_thickness.cell_m / 2
        before = max(0, math.ceil((low - (float(other[axis][0]) - half)) / cell - 1e-9))
        behind = max(0, math.ceil((float(other[axis][-1]) + half - high) / cell - 1e-9))
        edges.append(low + cell * numpy.arange(-before, own.sizes[axis] + behind + 1))
    return edges


def _volume_on(edges, thickness):
    """The volume [m3] of a map of thickness in the cells between these edges."""
    def overlap(axis, target):
        own = thickness[axis].values
        half = thickness.cell_m / 2
        low = numpy.maximum(own[:, None] - half, target[None, :-1])
        return numpy.maximum(0, numpy.minimum(own[:, None] + half, target[None, 1:]) - low)

    return overlap("y", edges[1]).T @ numpy.nan_to_num(thickness.values) @ overlap("x", edges[0])
