#include "common/domain/point_file.hpp"
#include "solver/run/recorders/frame_store.hpp"

namespace talus::solver {

void write_points_vdb(const std::filesystem::path& path, const PointFrame& frame, double spacing) {
  std::filesystem::create_directories(path.parent_path());
  write_point_file(
      path, {.time = frame.time,
             .voxel = spacing,
             .positions = frame.position,
             .attributes = {
                 {"v", frame.velocity}, {"volume", frame.volume}, {"pressure", frame.pressure}, {"id", frame.id}}});
}

}  // namespace talus::solver
