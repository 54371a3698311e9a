// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/options/three_d.hpp"

namespace talus::postprocess {

void ThreeDOptions::describe(recipe::Visitor& v) {
  v.flag("surface", surface, "surface of the flow over time as a mesh, for ParaView: 3d/surface.pvd");
  v.flag("terrain", terrain, "the ground with all maps on it, for ParaView: 3d/terrain.vtp");
  v.flag("points", points, "the material points over time, for ParaView: 3d/points.pvd; needs a run with point frames");
  v.number("largest_MB", largest, recipe::positive,
           "most that may be written into 3d/, by an estimate that is made beforehand; more is refused");
  v.flag("report", report, "a view in 3-D in the report: terrain, flow over time, deposit");
}

}  // namespace talus::postprocess
