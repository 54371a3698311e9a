# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a run by ParaView: pvpython draw_paraview.py OUT. Ground, and the flow coloured by its thickness.

It stands alone, since ParaView finds no display once GDAL's or HDF5's Python is loaded.
"""
import math
import sys

from paraview import simple as pv

size = [800, 600]


def show(out, view):
    terrain = pv.OpenDataFile(f"{out}/3d/terrain.vtp")
    ground = pv.Show(terrain, view)
    ground.ColorArrayName = [None, ""]
    ground.DiffuseColor = ground.AmbientColor = [0.72, 0.72, 0.68]
    flow = pv.OpenDataFile(f"{out}/3d/surface.pvd")
    times = list(flow.TimestepValues)
    view.ViewTime = times[len(times) // 3]
    flow.UpdatePipeline(view.ViewTime)
    shown = pv.Show(flow, view)
    pv.ColorBy(shown, ("POINTS", "thickness"))
    colours = pv.GetColorTransferFunction("thickness")
    colours.RescaleTransferFunction(0.0, flow.PointData["thickness"].GetRange()[1])
    shown.SetScalarBarVisibility(view, False)
    return terrain.GetDataInformation().GetBounds()


def main():
    out = sys.argv[1]
    view = pv.CreateRenderView(ViewSize=size, Background=[1, 1, 1], OrientationAxesVisibility=0)
    view.UseColorPaletteForBackground = 0
    west, east, south, north, low, high = show(out, view)
    middle = [0.5 * (west + east), 0.5 * (south + north), 0.5 * (low + high)]
    far = 1.35 * math.hypot(east - west, north - south)
    view.CameraFocalPoint = middle
    view.CameraPosition = [middle[0] + 0.2 * far, middle[1] - 0.75 * far, middle[2] + 0.65 * far]
    view.CameraViewUp = [0, 0, 1]
    pv.SaveScreenshot(f"{out}/paraview.png", view, ImageResolution=size)


main()
