# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes read by OpenVDB's own Python: check_volumes.py OUT.

Mass, momentum and place of each frame are those of the points.
"""
import sys

import numpy as np
import pyopenvdb

from run_facts import Run, expect


def cells(grid):
    """Indices of the voxels that hold something, values of the box around them, and the index of its corner."""
    low, high = grid.evalActiveVoxelBoundingBox()
    values = np.zeros([h - l + 1 for l, h in zip(low, high)], dtype=np.float32)
    grid.copyToArray(values, ijk=low)
    return np.argwhere(values > 0) + np.array(low), values, low


def check_frame(run, frame, path):
    density, velocity = pyopenvdb.read(path, "density"), pyopenvdb.read(path, "velocity")
    side = density.transform.voxelSize()[0]
    places, rho, low = cells(density)
    at = tuple((places - np.array(low)).T)
    mass = rho[at].astype(float) * side**3
    dense = np.zeros(rho.shape + (3,), dtype=np.float32)
    velocity.copyToArray(dense, ijk=low)
    momentum = (dense[at].astype(float) * mass[:, None]).sum(axis=0)
    positions, velocities, volumes = run.points(frame)
    true_mass = run.density * volumes.sum()
    true_momentum = run.density * (velocities * volumes[:, None]).sum(axis=0)
    words = expect(f"t = {run.point_times()[frame]:g} s, mass over the run's", mass.sum() / true_mass, 1, 1e-6)
    scale = run.density * (np.linalg.norm(velocities, axis=1) * volumes).sum() + 1e-9 * true_mass
    expect("momentum", momentum / scale, true_momentum / scale, 1e-5)
    origin = np.array([density.metadata[f"origin_{a}_m"] for a in "xyz"])
    centre = ((places + 0.5) * side * mass[:, None]).sum(axis=0) / mass.sum() + origin
    true_centre = (positions * volumes[:, None]).sum(axis=0) / volumes.sum()
    expect("centre of mass [m]", centre, true_centre, 0.5 * side)
    expect("time", density.metadata["time_s"], run.point_times()[frame], 0)
    return f"{words}; centre of mass off by {np.abs(centre - true_centre).max():.2g} m of voxels of {side:g} m"


def main():
    out = sys.argv[1]
    run = Run(out)
    frames = len(run.point_times())
    for frame in range(frames):
        words = check_frame(run, frame, f"{out}/3d/volumes/flow.{frame:04}.vdb")
        if frame in (0, frames // 2, frames - 1):
            print(words)


main()
