// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/point_file.hpp"

#include <openvdb/openvdb.h>

#include "common/domain/point_grid.hpp"
#include "common/domain/write_grids.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace {

/// Adds an attribute of whichever type.
void attach(PointGrid& grid, const std::string& name, const PointValues& values) {
  if (const auto* vectors = std::get_if<std::vector<std::array<float, 3>>>(&values)) {
    std::vector<openvdb::Vec3f> stored;
    for (const auto& v : *vectors) stored.emplace_back(v[0], v[1], v[2]);
    grid.attach(name, stored);
  } else if (const auto* numbers = std::get_if<std::vector<float>>(&values)) {
    grid.attach(name, *numbers);
  } else {
    grid.attach(name, std::get<std::vector<std::int32_t>>(values));
  }
}

}  // namespace

void write_point_file(const std::filesystem::path& path, const PointFile& points) {
  openvdb::initialize();
  PendingFile pending(path);
  try {
    std::vector<openvdb::Vec3d> positions;
    for (const auto& x : points.positions) positions.emplace_back(x[0], x[1], x[2]);
    PointGrid sorted(positions, *openvdb::math::Transform::createLinearTransform(points.voxel));
    for (const auto& [name, values] : points.attributes) attach(sorted, name, values);
    sorted.grid()->setName("points");
    sorted.grid()->insertMeta("time_s", openvdb::DoubleMetadata(points.time));
    sorted.grid()->insertMeta("run_id", openvdb::StringMetadata(points.run_id));
    write_grids(pending.path(), path, {sorted.grid()});
  } catch (const openvdb::Exception& error) {
    throw DataError(write_fault(path, error.what()));
  }
  pending.commit();
}

}  // namespace talus
