// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>

#include <openvdb/io/Stream.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tree/LeafManager.h>

#include "common/domain/domain.hpp"
#include "common/domain/domain_layout.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/files.hpp"
#include "common/stage/signals.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using openvdb::points::AttributeHandle;
using openvdb::points::PointDataGrid;

constexpr auto make_it = "Make it with talus-preprocess";
constexpr auto again = "Run talus-preprocess again, or copy it again";

[[noreturn]] void refuse(const fs::path& file, const std::string& what, const std::string& why,
                         const std::string& mend = make_it) {
  refuse_file(file, what, why, mend);
}

struct Contents {
  openvdb::GridPtrVecPtr grids;
  openvdb::MetaMap::Ptr meta;
};

/// Through a stream that throws at the end of the file: OpenVDB itself would go on with whatever it has.
Contents read_all(const fs::path& file, std::ifstream& stream) {
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  try {
    openvdb::io::Stream archive(stream, false);
    return {archive.getGrids(), archive.getMetadata()};
  } catch (const std::ios_base::failure&) {
    require_read(stream, file);
    refuse(file, "ends too early", "the file is truncated: its writing or copying was cut short", again);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // OpenVDB throws its own and std:: kinds on bytes that make no sense
    refuse(file, "cannot be read", std::string("the file is damaged: ") + error.what(), again);
  }
}

/// Metadata by name, with a fault that says which is missing.
class StoredFacts {
 public:
  StoredFacts(const fs::path& file, const openvdb::MetaMap& meta) : file_(file), meta_(meta) {}

  template <class T>
  T get(const std::string& name) const {
    const auto typed = meta_.getMetadata<openvdb::TypedMetadata<T>>(name);
    if (!typed) refuse(file_, "not a domain of talus-preprocess", "the entry \"" + name + "\" is missing");
    return typed->value();
  }
  std::size_t count(const std::string& name) const {
    const auto value = get<std::int64_t>(name);
    if (value < 0) refuse(file_, "not a domain of talus-preprocess", "the entry \"" + name + "\" is negative");
    return static_cast<std::size_t>(value);
  }
  int number(const std::string& name) const {
    const auto value = count(name);
    if (value > std::numeric_limits<int>::max())
      refuse(file_, "not a whole domain", "the entry \"" + name + "\" is " + std::to_string(value));
    return static_cast<int>(value);
  }
  std::string text(const std::string& name) const { return get<std::string>(name); }

 private:
  const fs::path& file_;
  const openvdb::MetaMap& meta_;
};

void check_kind(const fs::path& file, const openvdb::MetaMap& meta) {
  const auto kind = meta.getMetadata<openvdb::StringMetadata>("kind");
  if (!kind || kind->value() != layout::kind)
    refuse(file, "not a domain of talus-preprocess", "an OpenVDB file of another program");
  const auto format = StoredFacts(file, meta).get<std::int64_t>("format");
  if (format != layout::format) refuse_format(file, format, layout::format, "Run talus-preprocess again");
}

template <class Grid>
typename Grid::Ptr grid_named(const fs::path& file, const Contents& contents, const char* name) {
  for (const auto& grid : *contents.grids)
    if (grid->getName() == name)
      if (auto typed = openvdb::gridPtrCast<Grid>(grid)) return typed;
  refuse(file, "not a whole domain", std::string("the grid \"") + name + "\" is missing");
}

/// The values of a grid, which goes: it takes eight times the room, as most of its leaves' layers are empty.
Raster take_sheet(const fs::path& file, const Contents& contents, const char* name, const MapGrid& map) {
  const auto grid = grid_named<openvdb::DoubleGrid>(file, contents, name);
  const openvdb::CoordBBox cells(openvdb::Coord(0, 0, 0), openvdb::Coord(map.columns - 1, map.rows - 1, 0));
  if (const auto box = grid->evalActiveVoxelBoundingBox(); !box.empty() && !cells.isInside(box))
    refuse(file, "not a whole domain", std::string("the grid \"") + name + "\" goes beyond the map");
  const auto accessor = grid->getConstAccessor();
  Raster raster{map, std::vector<double>(map.count(), std::nan(""))};
  double value = 0;
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      if (accessor.probeValue(openvdb::Coord(column, row, 0), value)) raster.at(column, row) = value;
  grid->clear();
  return raster;
}

/// The mask of the background grid's cells: it must be made of whole blocks, and be of the grid of the header.
ActiveCells active_mask(const fs::path& file, const Contents& contents, const Domain& domain) {
  const auto grid = grid_named<openvdb::MaskGrid>(file, contents, layout::active);
  const StoredFacts facts(file, *grid);
  if (facts.get<double>(layout::mask_h) != domain.grid.cell ||
      facts.get<double>(layout::mask_h_z) != domain.layer_height)
    refuse(file, "not a whole domain", "the mask \"active\" has other cells than the grid");
  ActiveCells cells(domain.grid.columns, domain.grid.rows);
  constexpr int most_layers = 1 << 20;
  const openvdb::CoordBBox map(openvdb::Coord(0, 0, 0), openvdb::Coord(cells.columns - 1, cells.rows - 1, most_layers));
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    openvdb::CoordBBox box;  // a voxel, or a tile of many
    value.getBoundingBox(box);
    if (!map.isInside(box)) refuse(file, "not a whole domain", "the mask \"active\" goes beyond the map");
    for (int row = box.min().y(); row <= box.max().y(); ++row)
      for (int column = box.min().x(); column <= box.max().x(); ++column)
        cells.block_of(column, row).add({box.min().z(), box.max().z()});
  }
  if (cells.cell_count() != grid->activeVoxelCount())
    refuse(file, "not a whole domain", "the mask \"active\" is not made of whole blocks of 4 x 4 columns");
  return cells;
}

/// Points of one leaf, each to the place its id names. Leaves may be read at the same time.
void take_leaf(const fs::path& file, const PointDataGrid::TreeType::LeafNodeType& leaf, const MapGrid& map,
               SeedPoints& points, std::vector<unsigned char>& taken) {
  const AttributeHandle<openvdb::Vec3f> position(leaf.constAttributeArray("P"));
  const AttributeHandle<double> volume(leaf.constAttributeArray(layout::volume)),
      height(leaf.constAttributeArray(layout::height)), extent_x(leaf.constAttributeArray(layout::extent_x)),
      extent_y(leaf.constAttributeArray(layout::extent_y));
  const AttributeHandle<std::int32_t> release(leaf.constAttributeArray(layout::release));
  const AttributeHandle<std::int64_t> id(leaf.constAttributeArray(layout::id));
  for (auto point = leaf.beginIndexOn(); point; ++point) {
    const auto p = static_cast<std::size_t>(id.get(*point));
    if (p >= points.size()) refuse(file, "not a whole domain", "a point has an id beyond the count of points");
    if (std::atomic_ref(taken[p]).exchange(1) != 0)
      refuse(file, "not a whole domain", "two points have the id " + std::to_string(p));
    const openvdb::Coord voxel = point.getCoord();
    const openvdb::Vec3f offset = position.get(*point);  // from the voxel's centre, in voxels
    points.x[p] = map.west + (voxel.x() + 0.5 + static_cast<double>(offset.x())) * map.cell;
    points.y[p] = map.south + (voxel.y() + 0.5 + static_cast<double>(offset.y())) * map.cell;
    points.height[p] = height.get(*point);
    points.volume[p] = volume.get(*point);
    points.extent_x[p] = extent_x.get(*point);
    points.extent_y[p] = extent_y.get(*point);
    points.release[p] = release.get(*point);
  }
}

SeedPoints seed_points(const fs::path& file, const Contents& contents, const MapGrid& map, std::size_t count) {
  const auto grid = grid_named<PointDataGrid>(file, contents, layout::points);
  std::size_t found = 0;
  for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
    for (const char* name :
         {"P", layout::volume, layout::height, layout::extent_x, layout::extent_y, layout::release, layout::id})
      if (!leaf->hasAttribute(name))
        refuse(file, "not a whole domain", std::string("points have no attribute \"") + name + "\"");
    leaf->validateOffsets();  // throws
    found += leaf->onPointCount();
  }
  if (found != count)
    refuse(file, "holds " + std::to_string(found) + " points", "its header names " + std::to_string(count));
  SeedPoints points;
  for (auto* values : {&points.x, &points.y, &points.height, &points.volume, &points.extent_x, &points.extent_y})
    values->resize(count);
  points.release.resize(count);
  std::vector<unsigned char> taken(count);
  openvdb::tree::LeafManager<const PointDataGrid::TreeType>(grid->tree()).foreach ([&](const auto& leaf, std::size_t) {
    take_leaf(file, leaf, map, points, taken);
  });
  return points;
}

/// Lines and points under names.
std::vector<DomainPlace> named_places(const fs::path& file, const StoredFacts& facts) {
  std::vector<DomainPlace> places;
  const std::size_t count = facts.count(layout::places);
  for (std::size_t i = 0; i < count; ++i) {
    DomainPlace one{
        facts.text(layout::numbered(layout::place_of, i)), facts.text(layout::numbered(layout::place_name, i)), {}};
    const std::string entry = layout::numbered(layout::place_points, i);
    const auto points = points_in(facts.text(entry));
    if (!points) refuse(file, "not a whole domain", "the entry \"" + entry + "\" holds no points");
    one.points = *points;
    places.push_back(std::move(one));
  }
  return places;
}

Domain assemble(const fs::path& file, const Contents& contents) {
  const StoredFacts facts(file, *contents.meta);
  Domain domain;
  domain.grid = {facts.number("columns"),      facts.number("rows"),        facts.get<double>("west_m"),
                 facts.get<double>("south_m"), facts.get<double>("cell_m"), facts.text("crs_wkt")};
  domain.layer_height = facts.get<double>("layer_height_m");
  check_domain_grid(file, domain.grid, domain.layer_height);
  domain.terrain = take_sheet(file, contents, layout::terrain, domain.grid);
  domain.before = take_sheet(file, contents, layout::before, domain.grid);
  domain.release_thickness = take_sheet(file, contents, layout::release_thickness, domain.grid);
  for (const auto& grid : *contents.grids) {
    const std::string name = grid->getName();
    if (name.rfind(layout::bed_prefix, 0) != 0) continue;
    domain.bed.emplace_back(name.substr(std::string(layout::bed_prefix).size()),
                            take_sheet(file, contents, name.c_str(), domain.grid));
  }
  for (std::size_t i = 0; i < facts.count("releases"); ++i)
    domain.release_names.push_back(facts.text(layout::numbered("release_name", i)));
  domain.erodible = facts.number("erodible");
  domain.places = named_places(file, facts);
  auto findings = findings_in(facts.text(layout::findings));
  auto obstacles = places_in(facts.text(layout::obstacles));
  if (!findings || !obstacles)
    refuse(file, "not a whole domain", "the entry \"findings\" or \"obstacles\" is not of this program");
  domain.findings = std::move(*findings);
  domain.obstacles = std::move(*obstacles);
  for (std::size_t i = 0; i < facts.count("facts"); ++i)
    domain.provenance.emplace_back(facts.text(layout::numbered("fact_name", i)),
                                   facts.text(layout::numbered("fact_value", i)));
  domain.points = seed_points(file, contents, domain.grid, facts.count("points"));
  domain.active = active_mask(file, contents, domain);
  check_domain(file, domain);
  return domain;
}

std::string text(const openvdb::MetaMap& meta, const std::string& name) {
  const auto value = meta.getMetadata<openvdb::StringMetadata>(name);
  return value ? value->value() : "";
}

}  // namespace

Domain read_domain(const fs::path& file) {
  if (!fs::exists(file)) refuse(file, "no such file", "", "Run talus-preprocess first, with the same --out");
  std::ifstream stream = open_sealed_stream(file, again);
  openvdb::initialize();
  const WhileReading reading(file, again);
  const Contents contents = read_all(file, stream);
  check_kind(file, *contents.meta);
  try {
    return assemble(file, contents);
  } catch (const openvdb::Exception& error) {
    refuse(file, "not a whole domain", error.what());
  }
}

Facts domain_facts(const fs::path& file) {
  require_seal(file, again);
  openvdb::initialize();
  Facts facts;
  try {
    openvdb::io::File head(file.string());
    head.open();  // grids are read when they are asked for
    const auto meta = head.getMetadata();
    for (std::size_t i = 0; !text(*meta, layout::numbered("fact_name", i)).empty(); ++i)
      facts.emplace_back(text(*meta, layout::numbered("fact_name", i)), text(*meta, layout::numbered("fact_value", i)));
  } catch (const openvdb::Exception& error) {
    refuse(file, "not a whole domain", error.what(), again);
  }
  return facts;
}

}  // namespace talus
