# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and points opened by ParaView: pvpython check_paraview.py OUT.

Files are opened as a double click does, by their names alone.
"""
import sys

import numpy as np
from paraview import servermanager
from paraview import simple as pv
from vtkmodules.numpy_interface import dataset_adapter as dsa
from vtkmodules.util.numpy_support import vtk_to_numpy

from run_facts import Run, expect


def at_time(reader, time):
    reader.UpdatePipeline(time)
    return servermanager.Fetch(reader)


def below(mesh):
    """Volume between bed and surface, from the corners of the quadrilaterals [m3]."""
    data = dsa.WrapDataObject(mesh)
    if mesh.GetNumberOfCells() == 0:
        return 0.0
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    points = np.array(data.Points)
    height = points[:, 2] - np.array(data.PointData["bed"])
    x, y = points[corners, 0], points[corners, 1]
    area = 0.5 * np.abs(
        (x[:, 2] - x[:, 0]) * (y[:, 3] - y[:, 1]) - (x[:, 3] - x[:, 1]) * (y[:, 2] - y[:, 0])
    )
    return float((area * height[corners].mean(axis=1)).sum())


def check_surface(run, out):
    reader = pv.OpenDataFile(f"{out}/3d/surface.pvd")
    expect("times of surface.pvd", list(reader.TimestepValues), run.times, 1e-9)
    for frame, time in enumerate(run.times):
        volume = run.thickness(frame).sum() * run.cell**2
        # 1 mm is not drawn, and heights are rounded to 1/1024 m.
        found = below(at_time(reader, time)) / volume
        words = expect(f"t = {time:g} s, volume below the surface over the map's", found, 1, 2e-4)
        if frame in (0, len(run.times) // 2, len(run.times) - 1):
            print(words)
    return reader


def check_points(run, out):
    reader = pv.OpenDataFile(f"{out}/3d/points.pvd")
    expect("times of points.pvd", list(reader.TimestepValues), run.point_times(), 1e-9)
    for frame, time in enumerate(run.point_times()):
        data = dsa.WrapDataObject(at_time(reader, time))
        positions, velocities, volumes = run.points(frame)
        expect("points", data.GetNumberOfPoints(), len(volumes), 0)
        expect("positions", np.array(data.Points), positions, 0.5 / 1024 + 1e-9)
        expect("velocities", np.array(data.PointData["velocity"]), velocities, 0)
        expect("volume", np.array(data.PointData["volume"]).sum(dtype=float), volumes.sum(), 1e-9 * volumes.sum())
    print(f"{len(run.point_times())} frames of points: number, places, velocities and volumes as in run.h5")
    return reader


def check_terrain(run, out):
    reader = pv.OpenDataFile(f"{out}/3d/terrain.vtp")
    mesh = at_time(reader, 0)
    terrain = np.array(run.file["maps/terrain"])
    expect("lowest and highest ground", mesh.GetBounds()[4:], [np.nanmin(terrain), np.nanmax(terrain)], 1e-3)
    half = 0.5 * run.cell
    edges = [run.west + half, run.west + run.columns * run.cell - half]
    if not np.isnan(terrain).any():
        expect("west and east", mesh.GetBounds()[:2], edges, 1e-3)
    deposit = np.array(dsa.WrapDataObject(mesh).PointData["deposit_thickness"], dtype=float)
    true_deposit = np.nansum(np.array(run.file["maps/deposit_thickness"]))
    print(expect("deposit on the terrain over the map's", np.nansum(deposit) / true_deposit, 1, 1e-5))
    return reader


def main():
    out = sys.argv[1]
    run = Run(out)
    check_surface(run, out)
    check_points(run, out)
    check_terrain(run, out)
    together = pv.OpenDataFile(f"{out}/3d/run.pvd")
    expect("times of run.pvd", list(together.TimestepValues), run.times, 1e-9)


main()
