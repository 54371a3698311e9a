// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/point_file.hpp"
#include "common/stage/stage.hpp"
#include "solver/run/recorders/frame_store.hpp"

namespace talus::solver {

void write_points_vdb(const std::filesystem::path& path, const PointFrame& frame, double spacing,
                      const std::string& run_id) {
  make_folder(path.parent_path());
  write_point_file(
      path, {.time = frame.time,
             .run_id = run_id,
             .voxel = spacing,
             .positions = frame.position,
             .attributes = {
                 {"v", frame.velocity}, {"volume", frame.volume}, {"pressure", frame.pressure}, {"id", frame.id}}});
}

}  // namespace talus::solver
