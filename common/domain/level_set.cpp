#include "common/domain/level_set.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/error.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using Vector = openvdb::Vec3d;

constexpr double band = 3;  // of a level set on either side of its surface, in voxels

openvdb::FloatGrid::Ptr open_grid(const fs::path& file, const std::string& name) {
  if (!fs::exists(file))
    refuse_file(
        file, "no such file", "",
        "Check [[solve.obstacle]] level_set; talus-preprocess writes obstacles.vdb from [[preprocess.obstacle]]");
  require_plain(file);
  try {
    openvdb::io::File archive(file.string());
    archive.open();
    std::vector<std::string> names;
    for (auto entry = archive.beginName(); entry != archive.endName(); ++entry) names.push_back(entry.gridName());
    std::sort(names.begin(), names.end());
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    if ((name.empty() && names.size() != 1) || (!name.empty() && !known)) {
      refuse_file(
          file, name.empty() ? fmt::format("holds {} grids", names.size()) : fmt::format("holds no grid \"{}\"", name),
          fmt::format("its grids are: {}", fmt::join(names, ", ")), "Name one of them: grid = \"...\"");
    }
    const auto grid = archive.readGrid(name.empty() ? names.front() : name);
    auto typed = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (!typed || typed->getGridClass() != openvdb::GRID_LEVEL_SET) {
      refuse_file(file, fmt::format("the grid \"{}\" is no level set", grid->getName()),
                  "a level set is a float grid of class \"level set\", negative inside the body",
                  "Write it as one (Houdini: VDB from Polygons; OpenVDB: tools::meshToLevelSet)");
    }
    return typed;
  } catch (const openvdb::Exception& error) {
    refuse_file(file, "cannot be read", error.what(), "Write it again");
  }
}

/// Adds a triangle in pieces that are small enough.
void add_triangle(BodySurface& surface, const std::array<double, 3>& largest, const Vector& a, const Vector& b,
                  const Vector& c) {
  const Vector ab = b - a, bc = c - b, ca = a - c;
  const auto over = [&](const Vector& edge) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis)
      most = std::max(most, std::abs(edge[axis]) / largest[static_cast<std::size_t>(axis)]);
    return most;
  };
  const double longest = std::max({over(ab), over(bc), over(ca)});
  if (longest > 1) {  // halves its worst edge
    if (over(ab) == longest) {
      const Vector m = 0.5 * (a + b);
      add_triangle(surface, largest, a, m, c);
      add_triangle(surface, largest, m, b, c);
    } else if (over(bc) == longest) {
      add_triangle(surface, largest, b, c, a);
    } else {
      add_triangle(surface, largest, c, a, b);
    }
    return;
  }
  const Vector area = 0.5 * ab.cross(-ca), centre = (a + b + c) / 3;
  surface.volume += area.dot(centre - Vector(surface.low[0], surface.low[1], surface.low[2])) / 3;
  surface.facets.push_back({{centre[0], centre[1], centre[2]}, {area[0], area[1], area[2]}});
}

}  // namespace

BodySurface read_level_set(const fs::path& file, const std::string& name, const std::array<double, 3>& largest) {
  openvdb::initialize();
  const auto grid = open_grid(file, name);
  std::vector<openvdb::Vec3s> corners;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  // In index space, so that single precision does not see how far from the origin the map lies.
  const openvdb::math::Transform::Ptr place = grid->transform().copy();
  grid->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  openvdb::tools::volumeToMesh(*grid, corners, triangles, quads, 0.0);
  const auto at = [&](openvdb::Index32 n) { return place->indexToWorld(Vector(corners[n])); };
  BodySurface surface;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const Vector p = at(static_cast<openvdb::Index32>(n));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      surface.low[axis] = std::min(surface.low[axis], p[static_cast<int>(axis)]);
      surface.high[axis] = std::max(surface.high[axis], p[static_cast<int>(axis)]);
    }
  }
  // OpenVDB's faces run clockwise seen from outside.
  for (const auto& t : triangles) add_triangle(surface, largest, at(t[0]), at(t[2]), at(t[1]));
  for (const auto& q : quads) {
    add_triangle(surface, largest, at(q[0]), at(q[2]), at(q[1]));
    add_triangle(surface, largest, at(q[0]), at(q[3]), at(q[2]));
  }
  if (surface.facets.empty() || !(surface.volume > 0)) {
    refuse_file(
        file, fmt::format("the level set \"{}\" encloses nothing", grid->getName()),
        fmt::format("its surface has {} pieces", surface.facets.size()),
        "A level set is negative inside the body; write it with smaller voxels if the body is thinner than one");
  }
  return surface;
}

void write_level_sets(const fs::path& file, const std::vector<SolidBody>& bodies, double voxel) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  for (const SolidBody& body : bodies) {
    const auto far = static_cast<float>(band * voxel);
    auto grid = openvdb::FloatGrid::create(far);
    auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    transform->postTranslate(Vector(body.low[0], body.low[1], body.low[2]));
    const auto last = [&](std::size_t axis) {
      return static_cast<int>(std::ceil((body.high[axis] - body.low[axis]) / voxel + band));
    };
    const int margin = static_cast<int>(band);
    auto accessor = grid->getAccessor();
    bool any = false;
    for (int i = -margin; i <= last(0); ++i) {
      for (int j = -margin; j <= last(1); ++j) {
        for (int k = -margin; k <= last(2); ++k) {
          const double d = body.distance(body.low[0] + i * voxel, body.low[1] + j * voxel, body.low[2] + k * voxel);
          if (std::abs(d) < band * voxel) accessor.setValueOn({i, j, k}, static_cast<float>(d));
          any = any || d < 0;
        }
      }
    }
    if (!any)
      refuse_file(file, fmt::format("the body \"{}\" lies between the voxels", body.name),
                  fmt::format("they are {:g} m wide", voxel), "Take smaller ones");
    openvdb::tools::signedFloodFill(grid->tree());
    grid->setTransform(transform);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName(body.name);
    grids.push_back(grid);
  }
  PendingFile pending(file);
  try {
    openvdb::io::File(pending.path().string()).write(grids);
  } catch (const openvdb::Exception& error) {
    throw DataError(write_fault(file, error.what()));
  }
  pending.commit();
}

}  // namespace talus
