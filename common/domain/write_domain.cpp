// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/PointIndexGrid.h>
#include <openvdb/tree/LeafManager.h>

#include "common/domain/domain.hpp"
#include "common/domain/domain_layout.hpp"
#include "common/domain/grids.hpp"
#include "common/map/raster.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// Lowest ground: the local origin of heights.
double bottom_of(const Raster& terrain) {
  double bottom = std::numeric_limits<double>::infinity();
  for (const double value : terrain.values)
    if (!std::isnan(value)) bottom = std::min(bottom, value);
  return std::isfinite(bottom) ? bottom : 0;
}

/// Where the points stand in space, for those who look at the file; the solver takes x, y and the height attribute.
std::vector<openvdb::Vec3d> positions_of(const Domain& domain, double bottom) {
  const SeedPoints& points = domain.points;
  std::vector<openvdb::Vec3d> positions(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double ground = bilinear(domain.terrain, points.x[p], points.y[p]);
    positions[p] = {points.x[p], points.y[p], (std::isnan(ground) ? bottom : ground) + points.height[p]};
  }
  return positions;
}

/// Adds an attribute with one value for each point; `order` tells which of them stand in each leaf.
template <class Value>
void attach(openvdb::points::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& order, const char* name,
            const std::vector<Value>& values) {
  auto& tree = grid.tree();
  openvdb::points::appendAttribute(tree, name, openvdb::points::TypedAttributeArray<Value>::attributeType());
  openvdb::tree::LeafManager<openvdb::points::PointDataTree>(tree).foreach ([&](auto& leaf, std::size_t) {
    openvdb::points::AttributeWriteHandle<Value> attribute(leaf.attributeArray(name));
    openvdb::Index place = 0;
    for (const auto index : order.tree().probeConstLeaf(leaf.origin())->indices())
      attribute.set(place++, values[index]);
    attribute.compact();
  });
}

openvdb::GridBase::Ptr point_grid(const Domain& domain, double bottom) {
  using openvdb::points::PointDataGrid, openvdb::tools::PointIndexGrid;
  const SeedPoints& points = domain.points;
  const std::vector<openvdb::Vec3d> positions = positions_of(domain, bottom);
  const openvdb::points::PointAttributeVector<openvdb::Vec3d> wrapped(positions);
  const auto transform = layout::transform(domain.grid, domain.layer_height, bottom);
  const auto order = openvdb::tools::createPointIndexGrid<PointIndexGrid>(wrapped, *transform);
  const auto grid =
      openvdb::points::createPointDataGrid<openvdb::points::NullCodec, PointDataGrid>(*order, wrapped, *transform);
  std::vector<std::int64_t> ids(points.size());
  std::iota(ids.begin(), ids.end(), 0);
  attach(*grid, *order, layout::volume, points.volume);
  attach(*grid, *order, layout::height, points.height);
  attach(*grid, *order, layout::extent_x, points.extent_x);
  attach(*grid, *order, layout::extent_y, points.extent_y);
  attach(*grid, *order, layout::release, std::vector<std::int32_t>(points.release.begin(), points.release.end()));
  attach(*grid, *order, layout::id, ids);
  grid->setName(layout::points);
  grid->insertMeta("units",
                   openvdb::StringMetadata("position m, volume m3, height m above the bed, vertical, extent m"));
  return grid;
}

/// The cells of a raster that hold a number, leaf by leaf.
template <class Grid, class Value>
openvdb::GridBase::Ptr sheet(const Domain& domain, double bottom, const Raster& raster, const char* name,
                             Value&& value) {
  constexpr int side = Grid::TreeType::LeafNodeType::DIM;
  auto grid = Grid::create();
  for (int south = 0; south < raster.grid.rows; south += side)
    for (int west = 0; west < raster.grid.columns; west += side) {
      typename Grid::TreeType::LeafNodeType* leaf = nullptr;
      for (int row = south; row < std::min(south + side, raster.grid.rows); ++row)
        for (int column = west; column < std::min(west + side, raster.grid.columns); ++column) {
          const double cell = raster.at(column, row);
          if (std::isnan(cell)) continue;
          if (leaf == nullptr) leaf = grid->tree().touchLeaf(openvdb::Coord(west, south, 0));
          leaf->setValueOn(openvdb::Coord(column, row, 0), value(cell));
        }
    }
  grid->setName(name);
  grid->setTransform(layout::transform(domain.grid, domain.layer_height, bottom));
  return grid;
}

openvdb::GridBase::Ptr value_sheet(const Domain& domain, double bottom, const Raster& raster, const char* name) {
  auto grid = sheet<openvdb::DoubleGrid>(domain, bottom, raster, name, [](double cell) { return cell; });
  grid->insertMeta("units", openvdb::StringMetadata("m"));
  return grid;
}

/// The cells of the background grid around the points; voxel (column, row, layer).
openvdb::GridBase::Ptr active_mask(const Domain& domain, double bottom, const ActiveCells& cells) {
  auto grid = openvdb::MaskGrid::create();
  constexpr int side = ActiveCells::side;
  for (int row = 0; row < cells.rows; row += side)
    for (int column = 0; column < cells.columns; column += side) {
      const ActiveCells::Layers& layers = cells.block_of(column, row);
      if (layers.count() <= 0) continue;
      const openvdb::Coord last(std::min(column + side, cells.columns) - 1, std::min(row + side, cells.rows) - 1,
                                layers.last);
      grid->denseFill(openvdb::CoordBBox(openvdb::Coord(column, row, layers.first), last), true, true);
    }
  grid->setName(layout::active);
  grid->setTransform(layout::transform(domain.grid, domain.layer_height, bottom));
  grid->insertMeta(layout::mask_h, openvdb::DoubleMetadata(domain.grid.cell));
  grid->insertMeta(layout::mask_h_z, openvdb::DoubleMetadata(domain.layer_height));
  grid->insertMeta("units", openvdb::StringMetadata("voxel (column, row, layer above the bed); h and h_z in m"));
  return grid;
}

openvdb::MetaMap metadata_of(const Domain& domain) {
  openvdb::MetaMap meta;
  const auto number = [&](const std::string& name, double value) {
    meta.insertMeta(name, openvdb::DoubleMetadata(value));
  };
  const auto text = [&](const std::string& name, const std::string& value) {
    meta.insertMeta(name, openvdb::StringMetadata(value));
  };
  const auto count = [&](const std::string& name, std::size_t value) {
    meta.insertMeta(name, openvdb::Int64Metadata(static_cast<std::int64_t>(value)));
  };
  text("kind", layout::kind);
  count("format", layout::format);
  text("units", "SI; elevations and thicknesses vertical, m; volumes m3");
  count("columns", static_cast<std::size_t>(domain.grid.columns));
  count("rows", static_cast<std::size_t>(domain.grid.rows));
  number("west_m", domain.grid.west);
  number("south_m", domain.grid.south);
  number("cell_m", domain.grid.cell);
  number("layer_height_m", domain.layer_height);
  text("crs_wkt", domain.grid.crs_wkt);
  count("points", domain.points.size());
  count("releases", domain.release_names.size());
  count("erodible", static_cast<std::size_t>(domain.erodible));
  for (std::size_t i = 0; i < domain.release_names.size(); ++i)
    text(layout::numbered("release_name", i), domain.release_names[i]);
  count(layout::places, domain.places.size());
  for (std::size_t i = 0; i < domain.places.size(); ++i) {
    text(layout::numbered(layout::place_of, i), domain.places[i].place);
    text(layout::numbered(layout::place_name, i), domain.places[i].name);
    text(layout::numbered(layout::place_points, i), text_of_points(domain.places[i].points));
  }
  text(layout::findings, to_json(domain.findings));
  text(layout::obstacles, places_json(domain.obstacles));
  count("facts", domain.provenance.size());
  for (std::size_t i = 0; i < domain.provenance.size(); ++i) {
    text(layout::numbered("fact_name", i), domain.provenance[i].first);
    text(layout::numbered("fact_value", i), domain.provenance[i].second);
  }
  return meta;
}

/// OpenVDB does not look whether its stream still writes, so a full disk shows only on reading back.
void verify(const fs::path& partial, const fs::path& file, const Domain& domain, const ActiveCells& active) {
  bool same = false;
  std::string reason = "it does not read back as written";
  try {
    const Domain back = read_domain(partial);
    same = back.points.size() == domain.points.size() && back.points.volume == domain.points.volume &&
           back.active == active && back.places == domain.places;
  } catch (const DataError& error) {
    reason += ": " + error.faults().front().why;
  }
  if (!same) throw DataError(write_fault(file, reason));
}

/// Writes the grids; none of them is left in memory.
void write_all(const fs::path& partial, const fs::path& file, const Domain& domain, const ActiveCells& active) {
  const double bottom = bottom_of(domain.terrain);
  openvdb::GridPtrVec grids{
      point_grid(domain, bottom),
      value_sheet(domain, bottom, domain.terrain, layout::terrain),
      value_sheet(domain, bottom, domain.before, layout::before),
      value_sheet(domain, bottom, domain.release_thickness, layout::release_thickness),
      sheet<openvdb::MaskGrid>(domain, bottom, domain.terrain, layout::inside, [](double) { return true; }),
      active_mask(domain, bottom, active)};
  for (const auto& [name, raster] : domain.bed)
    grids.push_back(sheet<openvdb::DoubleGrid>(domain, bottom, raster, (layout::bed_prefix + name).c_str(),
                                               [](double cell) { return cell; }));
  write_grids(partial, file, grids, metadata_of(domain));
}

}  // namespace

void write_domain(const fs::path& file, const Domain& domain) {
  openvdb::initialize();
  PendingFile pending(file);
  const ActiveCells active = active_cells(domain.grid, domain.layer_height, domain.points);
  try {
    write_all(pending.path(), file, domain, active);
  } catch (const openvdb::Exception& error) {
    throw DataError(write_fault(file, error.what()));
  }
  seal_file(pending.path(), file);
  verify(pending.path(), file, domain, active);
  pending.commit();
}

}  // namespace talus
