// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/level_set.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <ios>
#include <new>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/domain/grids.hpp"
#include "common/error.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/files.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using Vector = openvdb::Vec3d;

constexpr double band = 3;  // of a level set on either side of its surface, in voxels
constexpr std::size_t most_facets = 50'000'000;
constexpr auto write_it = "Write it again (Houdini: VDB from Polygons; OpenVDB: tools::meshToLevelSet)";

struct Wanted {
  fs::path file;
  std::string grid;               ///< its name; empty: the only one
  std::array<double, 3> largest;  ///< extent of a facet [m]
};

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
    if ((name.empty() && names.size() != 1) || (!name.empty() && !known))
      refuse_file(
          file, name.empty() ? fmt::format("holds {} grids", names.size()) : fmt::format("holds no grid \"{}\"", name),
          fmt::format("its grids are: {}", fmt::join(names, ", ")), "Name one of them: grid = \"...\"");
    const auto grid = archive.readGrid(name.empty() ? names.front() : name);
    auto typed = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (!typed || typed->getGridClass() != openvdb::GRID_LEVEL_SET)
      refuse_file(file, fmt::format("the grid \"{}\" is no level set", grid->getName()),
                  "a level set is a float grid of class \"level set\", negative inside the body",
                  "Write it as one (Houdini: VDB from Polygons; OpenVDB: tools::meshToLevelSet)");
    return typed;
  } catch (const openvdb::Exception& error) {
    refuse_file(file, "cannot be read", error.what(), write_it);
  } catch (const std::ios_base::failure& error) {
    refuse_file(file, "cannot be read", error.what(), write_it);
  }
}

/// This function refuses a grid whose numbers are not those of a level set in space.
void check_numbers(const fs::path& file, const openvdb::FloatGrid& grid) {
  const auto refuse = [&](const std::string& why) {
    refuse_file(file, fmt::format("the level set \"{}\" cannot be", grid.getName()), why, write_it);
  };
  if (!grid.transform().isLinear()) refuse("its voxels are not all of one size");
  const openvdb::Mat4d place = grid.transform().baseMap()->getAffineMap()->getMat4();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      if (!(std::abs(place[row][column]) < 1e12)) refuse(fmt::format("its transform holds {:g}", place[row][column]));
  const double volume = std::abs(place.getMat3().det());
  if (!(volume > 1e-18 && volume < 1e18)) refuse(fmt::format("its voxels have {:g} m3", volume));
  if (!(grid.background() > 0) || !std::isfinite(grid.background()))
    refuse(fmt::format("the distance far from its surface is {:g}", grid.background()));
  for (auto value = grid.cbeginValueAll(); value; ++value)
    if (!std::isfinite(*value))
      refuse(fmt::format("at voxel {} {} {} it holds {:g}", value.getCoord().x(), value.getCoord().y(),
                         value.getCoord().z(), *value));
}

using Quad = std::array<Vector, 4>;  // corners, counter-clockwise seen from outside

Vector area_of(const Quad& q) { return 0.5 * (q[2] - q[0]).cross(q[3] - q[1]); }

/// Adds a quad in pieces that are small enough. What is turned or mirrored is cut alike.
void add_quad(BodySurface& surface, const std::array<double, 3>& largest, const Quad& q) {
  const Vector middle = 0.25 * (q[0] + q[1] + q[2] + q[3]);
  bool fits = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({q[0][axis], q[1][axis], q[2][axis], q[3][axis]});
    fits = fits && high - low <= largest[static_cast<std::size_t>(axis)];
  }
  if (!fits) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Vector after = 0.5 * (q[c] + q[(c + 1) % 4]), before = 0.5 * (q[c] + q[(c + 3) % 4]);
      add_quad(surface, largest, {q[c], after, middle, before});
    }
    return;
  }
  if (surface.facets.size() == most_facets) throw std::length_error("facets");
  const Vector area = area_of(q);
  surface.volume += area.dot(middle - Vector(surface.low[0], surface.low[1], surface.low[2])) / 3;
  surface.facets.push_back({{middle[0], middle[1], middle[2]}, {area[0], area[1], area[2]}});
}

/// Whether a surface of this area [m2] has more pieces than may be: a broken transform makes it endless. No piece is
/// larger than half the square over the diagonal of the largest extents.
bool too_many(const BodySurface& surface, const std::array<double, 3>& largest, double area) {
  double longest = 0, diagonal = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, (surface.high[axis] - surface.low[axis]) / largest[axis]);
    diagonal += largest[axis] * largest[axis];
  }
  return !(std::max(longest, 2 * area / diagonal) < static_cast<double>(most_facets));
}

[[noreturn]] void refuse_fine(const Wanted& wanted, const std::string& name, const BodySurface& surface) {
  refuse_file(wanted.file, fmt::format("the level set \"{}\" is too large for this grid", name),
              fmt::format("it spans {:g} x {:g} x {:g} m, and its surface would be cut into more than {} pieces",
                          surface.high[0] - surface.low[0], surface.high[1] - surface.low[1],
                          surface.high[2] - surface.low[2], most_facets),
              "Check its unit, which must be the metre, and its place");
}

BodySurface surface_in(const Wanted& wanted, const openvdb::FloatGrid::Ptr& grid) {
  const fs::path& file = wanted.file;
  const std::array<double, 3>& largest = wanted.largest;
  check_numbers(file, *grid);
  std::vector<openvdb::Vec3s> corners;
  std::vector<openvdb::Vec4I> faces;  // clockwise seen from outside
  // In index space, so that single precision does not see how far from the origin the map lies.
  const openvdb::math::Transform::Ptr place = grid->transform().copy();
  grid->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  openvdb::tools::volumeToMesh(*grid, corners, faces);
  std::vector<Vector> places;
  places.reserve(corners.size());
  BodySurface surface;
  for (const openvdb::Vec3s& corner : corners) {
    const Vector p = place->indexToWorld(Vector(corner));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      surface.low[axis] = std::min(surface.low[axis], p[static_cast<int>(axis)]);
      surface.high[axis] = std::max(surface.high[axis], p[static_cast<int>(axis)]);
    }
    places.push_back(p);
  }
  const auto quad = [&](const openvdb::Vec4I& f) {
    return Quad{places[f[3]], places[f[2]], places[f[1]], places[f[0]]};
  };
  double area = 0;
  for (const openvdb::Vec4I& face : faces) area += area_of(quad(face)).length();
  if (!places.empty() && too_many(surface, largest, area)) refuse_fine(wanted, grid->getName(), surface);
  try {
    for (const openvdb::Vec4I& face : faces) add_quad(surface, largest, quad(face));
  } catch (const std::length_error&) {
    refuse_fine(wanted, grid->getName(), surface);
  }
  if (surface.facets.empty() || !(surface.volume > 0))
    refuse_file(
        file, fmt::format("the level set \"{}\" encloses nothing", grid->getName()),
        fmt::format("its surface has {} pieces", surface.facets.size()),
        "A level set is negative inside the body; write it with smaller voxels if the body is thinner than one");
  return surface;
}

/// The level set of a body, on voxels about its middle: turned by a quarter or mirrored it has the same. Faults are
/// those of `file`.
openvdb::FloatGrid::Ptr level_set_of(const SolidBody& body, double voxel, const fs::path& file) {
  const auto far = static_cast<float>(band * voxel);
  auto grid = openvdb::FloatGrid::create(far);
  const Vector low(body.low.data()), high(body.high.data()), middle = 0.5 * (low + high);
  const auto last = [&](int axis) {
    return static_cast<int>(std::ceil((high[axis] - low[axis]) / (2 * voxel) + band));
  };
  auto accessor = grid->getAccessor();
  bool any = false;
  for (int i = -last(0); i <= last(0); ++i)
    for (int j = -last(1); j <= last(1); ++j)
      for (int k = -last(2); k <= last(2); ++k) {
        const Vector p = middle + voxel * Vector(i, j, k);
        double d = body.distance(p[0], p[1], p[2]);
        if (std::abs(d) < 1e-6 * voxel) d = 0;  // rounding does not tell the side
        if (std::abs(d) < band * voxel) accessor.setValueOn({i, j, k}, static_cast<float>(d));
        any = any || d < 0;
      }
  if (!any)
    refuse_file(file, fmt::format("the body \"{}\" lies between the voxels", body.name),
                fmt::format("they are {:g} m wide", voxel), "Take smaller ones");
  openvdb::tools::signedFloodFill(grid->tree());
  auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  transform->postTranslate(middle);
  grid->setTransform(transform);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setName(body.name);
  return grid;
}

/// Bounds the memory of this process until the end of the scope: OpenVDB allocates what a damaged file asks for.
class MemoryBound {
 public:
  explicit MemoryBound(double more) {
    ::getrlimit(RLIMIT_DATA, &before_);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers reserve far more than they use
    double pages = 0;
    std::ifstream statm("/proc/self/statm");
    for (int field = 0; field < 6; ++field) statm >> pages;  // the sixth: data and stack
    const double most = pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) + more;
    const rlimit bound{static_cast<rlim_t>(most), before_.rlim_max};
    if (statm && most < static_cast<double>(before_.rlim_cur)) ::setrlimit(RLIMIT_DATA, &bound);
#else
    static_cast<void>(more);
#endif
  }
  MemoryBound(const MemoryBound&) = delete;
  MemoryBound& operator=(const MemoryBound&) = delete;
  ~MemoryBound() { ::setrlimit(RLIMIT_DATA, &before_); }

 private:
  rlimit before_{};
};

}  // namespace

BodySurface read_level_set(const fs::path& file, const std::string& name, const std::array<double, 3>& largest) {
  check_seal(file, "Run talus-preprocess again, or copy it again");
  const WhileReading reading(file, write_it);  // OpenVDB crashes on some damaged files
  std::error_code unknown;
  const auto size = fs::is_regular_file(file, unknown) ? fs::file_size(file, unknown) : 0;
  const MemoryBound bound(0x1p31 + 64 * static_cast<double>(size));  // compressed contents unfold some ten times
  openvdb::initialize();
  try {
    return surface_in({file, name, largest}, open_grid(file, name));
  } catch (const std::bad_alloc&) {
    refuse_file(file, "cannot be read", "it asks for more memory than there is: it is damaged, or far too fine",
                write_it);
  }
}

BodySurface surface_of(const VoxelBody& given, const std::array<double, 3>& largest) {
  openvdb::initialize();
  return surface_in({given.body.name, "", largest}, level_set_of(given.body, given.voxel, given.body.name));
}

void write_level_sets(const fs::path& file, const std::vector<SolidBody>& bodies, double voxel) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  for (const SolidBody& body : bodies) grids.push_back(level_set_of(body, voxel, file));
  PendingFile pending(file);
  try {
    write_grids(pending.path(), file, grids);
  } catch (const openvdb::Exception& error) {
    throw DataError(write_fault(file, error.what()));
  }
  seal_file(pending.path(), file);
  pending.commit();
}

}  // namespace talus
