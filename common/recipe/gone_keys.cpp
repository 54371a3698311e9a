// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/gone_keys.hpp"

namespace talus::recipe {
namespace {

struct GoneKey {
  std::string_view place;   ///< "table.key", or "table.key=word" of a choice
  std::string_view advice;  ///< what to do instead, an imperative without a full stop
};

constexpr GoneKey gone_keys[] = {
    {"postprocess.three_d.volumes", "Leave it out; 3d/run.pvd opens in ParaView"},
    {"postprocess.three_d.voxel_m", "Leave it out; 3d/run.pvd opens in ParaView"},
    {"solve.flip_fraction", "Give transfer_time_s, the time over which velocity finer than the grid decays"},
    {"solve.ground_contact", "Leave it out; mapping = \"terrain-following\" meets steep ground where it is"},
    {"solve.implicit.linear_solver=bicgstab", "Take linear_solver = \"pcg\""},
    {"solve.implicit.operator", "Leave it out; the product goes point by point"},
    {"solve.implicit.preconditioner", "Leave it out; it is the 3 x 3 block of each node"},
    {"solve.implicit.tangent", "Leave it out; the tangent is symmetric, with the yield stress held"},
    {"solve.vdb_frames", "Leave it out; run.h5 holds the points (point_frames)"},
};

}  // namespace

std::string_view advice_on_gone(std::string_view place) {
  for (const GoneKey& gone : gone_keys) {
    if (gone.place == place) return gone.advice;
  }
  return {};
}

}  // namespace talus::recipe
