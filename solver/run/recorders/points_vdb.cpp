#include <openvdb/openvdb.h>

#include "common/domain/point_grid.hpp"
#include "common/stage/stage.hpp"
#include "solver/run/recorders/frame_store.hpp"

namespace talus::solver {

void write_points_vdb(const std::filesystem::path& path, const PointFrame& frame, double spacing) {
  openvdb::initialize();
  try {
    std::vector<openvdb::Vec3d> positions;
    std::vector<openvdb::Vec3f> velocities;
    for (const auto& x : frame.position) positions.emplace_back(x[0], x[1], x[2]);
    for (const auto& v : frame.velocity) velocities.emplace_back(v[0], v[1], v[2]);
    const auto transform = openvdb::math::Transform::createLinearTransform(spacing);
    PointGrid points(positions, *transform);
    points.attach("v", velocities);
    points.attach("volume", frame.volume);
    points.attach("pressure", frame.pressure);
    points.attach("id", frame.id);
    points.grid()->setName("points");
    points.grid()->insertMeta("time_s", openvdb::DoubleMetadata(frame.time));
    std::filesystem::create_directories(path.parent_path());
    PendingFile pending(path);
    openvdb::io::File file(pending.path().string());
    file.write({points.grid()});
    file.close();
    pending.commit();
  } catch (const openvdb::Exception& e) {
    throw DataError(
        {path.string() + ": the frame cannot be written", e.what(), "Free some space, or set vdb_frames = false"});
  }
}

}  // namespace talus::solver
