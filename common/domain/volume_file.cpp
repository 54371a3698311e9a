// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/volume_file.hpp"

#include <openvdb/openvdb.h>

#include <stdexcept>

#include "common/domain/write_grids.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace {

/// A grid's name, what it is of, and where it lies.
void describe_volume(openvdb::GridBase& grid, const char* name, const char* unit, const VolumeFile& volume) {
  grid.setName(name);
  auto transform = openvdb::math::Transform::createLinearTransform(volume.side);
  transform->postTranslate(openvdb::Vec3d(0.5 * volume.side));  // an index is the centre of its voxel
  grid.setTransform(transform);
  grid.insertMeta("unit", openvdb::StringMetadata(unit));
  grid.insertMeta("time_s", openvdb::DoubleMetadata(volume.time));
  grid.insertMeta("run_id", openvdb::StringMetadata(volume.run_id));
  grid.insertMeta("crs", openvdb::StringMetadata(volume.crs));
  grid.insertMeta("origin_x_m", openvdb::DoubleMetadata(volume.origin[0]));
  grid.insertMeta("origin_y_m", openvdb::DoubleMetadata(volume.origin[1]));
  grid.insertMeta("origin_z_m", openvdb::DoubleMetadata(volume.origin[2]));
}

}  // namespace

void write_volume_file(const std::filesystem::path& path, const VolumeFile& volume) {
  if (volume.density.size() != volume.voxels.size() || volume.velocity.size() != volume.voxels.size())
    throw std::logic_error("VolumeFile: lists of different lengths");
  openvdb::initialize();
  PendingFile pending(path);
  try {
    auto density = openvdb::FloatGrid::create(0.0F);
    auto velocity = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0F));
    density->setGridClass(openvdb::GRID_FOG_VOLUME);
    velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    auto masses = density->getAccessor();
    auto velocities = velocity->getAccessor();
    for (std::size_t n = 0; n < volume.voxels.size(); ++n) {
      const openvdb::Coord at(volume.voxels[n][0], volume.voxels[n][1], volume.voxels[n][2]);
      masses.setValue(at, volume.density[n]);
      velocities.setValue(at, openvdb::Vec3s(volume.velocity[n].data()));
    }
    describe_volume(*density, "density", "kg m-3", volume);
    describe_volume(*velocity, "velocity", "m s-1", volume);
    write_grids(pending.path(), path, {density, velocity});
  } catch (const openvdb::Exception& error) {
    throw DataError(write_fault(path, error.what()));
  }
  pending.commit();
}

}  // namespace talus
