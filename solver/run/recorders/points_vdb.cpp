#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointDataGrid.h>

#include "common/stage/stage.hpp"
#include "solver/run/recorders/frame_store.hpp"

namespace talus::solver {
namespace {

namespace vp = openvdb::points;

/// This function adds an attribute whose values are given in the points' own order.
template <class Value>
void add_attribute(vp::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& index, const std::string& name,
                   const std::vector<Value>& values) {
  vp::appendAttribute<Value>(grid.tree(), name);
  const vp::PointAttributeVector<Value> wrapped(values);
  vp::populateAttribute<vp::PointDataTree, openvdb::tools::PointIndexTree, vp::PointAttributeVector<Value>>(
      grid.tree(), index.tree(), name, wrapped);
}

}  // namespace

void write_points_vdb(const std::filesystem::path& path, const PointFrame& frame, double spacing) {
  openvdb::initialize();
  try {
    std::vector<openvdb::Vec3d> positions;
    std::vector<openvdb::Vec3f> velocities;
    for (const auto& x : frame.position) positions.emplace_back(x[0], x[1], x[2]);
    for (const auto& v : frame.velocity) velocities.emplace_back(v[0], v[1], v[2]);
    const auto transform = openvdb::math::Transform::createLinearTransform(spacing);
    const vp::PointAttributeVector<openvdb::Vec3d> wrapped(positions);
    const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapped, *transform);
    auto grid = vp::createPointDataGrid<vp::NullCodec, vp::PointDataGrid>(*index, wrapped, *transform);
    grid->setName("points");
    grid->insertMeta("time_s", openvdb::DoubleMetadata(frame.time));
    add_attribute(*grid, *index, "v", velocities);
    add_attribute(*grid, *index, "volume", frame.volume);
    add_attribute(*grid, *index, "pressure", frame.pressure);
    add_attribute(*grid, *index, "id", frame.id);
    std::filesystem::create_directories(path.parent_path());
    PendingFile pending(path);
    openvdb::io::File file(pending.path().string());
    file.write({grid});
    file.close();
    pending.commit();
  } catch (const openvdb::Exception& e) {
    throw DataError(
        {path.string() + ": the frame cannot be written", e.what(), "Free some space, or set vdb_frames = false"});
  }
}

}  // namespace talus::solver
