// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/options/three_d.hpp"

namespace talus::postprocess {

void ThreeDOptions::describe(recipe::Visitor& v) {
  v.flag("surface", surface, "surface of the flow over time as a mesh, for ParaView: 3d/surface.pvd");
  v.flag("terrain", terrain, "the ground with all maps on it, for ParaView: 3d/terrain.vtp");
  v.flag("points", points, "the material points over time, for ParaView: 3d/points.pvd; needs a run with point frames");
  v.flag("volumes", volumes,
         "density and velocity over time as sparse volumes, for Blender and Houdini: 3d/volumes/flow.0000.vdb and so "
         "on; needs a run with point frames");
  v.number("voxel_m", voxel, recipe::not_negative,
           "side of the voxels of the volumes, a whole part of the cell; 0: the cell, divided until it is no larger "
           "than a layer");
  v.number("largest_MB", largest, recipe::positive,
           "most that may be written into 3d/, by an estimate that is made beforehand; more is refused");
  v.flag("report", report, "a view in 3-D in the report: terrain, flow over time, deposit");
}

}  // namespace talus::postprocess
