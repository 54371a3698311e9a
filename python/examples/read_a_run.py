# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a run: what it says of itself, its history, its deposit; draws the deposit where matplotlib is there.

usage: read_a_run.py RESULTS [PICTURE.png]
"""
import sys

import talus


def main(results, picture=None):
    run = talus.open_run(results)
    print(f"{run.facts['title']}: {run.facts['particles']} points, {run.facts['stop_reason']} ({run.facts['sanity']})")
    history = run.history()
    fastest = history.speed_max_m_s.idxmax("time").item()
    print(f"fastest at {fastest:g} s, {history.speed_max_m_s.max().item():.1f} {history.speed_max_m_s.units}")

    deposit = run.maps().deposit_thickness
    volume = deposit.sum().item() * deposit.cell_m**2
    print(f"deposit: {volume:.0f} m3, {deposit.max().item():.2f} {deposit.units} at most")
    frames = run.thickness()  # a frame is read when it is looked at
    for time in frames.time.values:
        moved = abs(frames.sel(time=time) - frames.isel(time=0)).sum().item() / 2 * deposit.cell_m**2
        print(f"at {time:g} s {moved:.0f} m3 lie elsewhere than at the start")
    points = run.points(frame=-1)
    print(f"lowest point at the end: {points.z.min().item():.1f} m")
    if picture is not None:
        draw(deposit, picture)


def draw(deposit, picture):
    try:
        import matplotlib
    except ImportError:
        print("no picture: matplotlib is not installed (Debian: python3-matplotlib)")
        return
    matplotlib.use("Agg")  # a file, no window
    from matplotlib import pyplot

    axes = deposit.where(deposit > 0.1).plot(cmap="viridis").axes
    axes.set_aspect("equal")
    axes.ticklabel_format(style="plain", useOffset=False)
    axes.locator_params(nbins=5)
    axes.set_title("Deposit")
    pyplot.savefig(picture, dpi=150)
    print(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
