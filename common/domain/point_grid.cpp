// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/point_grid.hpp"

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/PointIndexGrid.h>

namespace talus {
namespace points = openvdb::points;

/// The points, and which of them stand in each leaf.
struct PointGrid::Trees {
  openvdb::tools::PointIndexGrid::Ptr order;
  points::PointDataGrid::Ptr grid;
};

PointGrid::PointGrid(const std::vector<openvdb::Vec3d>& positions, const openvdb::math::Transform& transform)
    : trees_(std::make_unique<Trees>()) {
  const points::PointAttributeVector<openvdb::Vec3d> wrapped(positions);
  trees_->order = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapped, transform);
  trees_->grid =
      points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*trees_->order, wrapped, transform);
}

PointGrid::~PointGrid() = default;

template <class Value>
void PointGrid::attach(const std::string& name, const std::vector<Value>& values) {
  auto& tree = trees_->grid->tree();
  points::appendAttribute(tree, name, points::TypedAttributeArray<Value>::attributeType());
  for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
    points::AttributeArray& array = leaf->attributeArray(name);
    points::AttributeWriteHandle<Value> attribute(array);
    openvdb::Index place = 0;
    for (const auto index : trees_->order->tree().probeConstLeaf(leaf->origin())->indices())
      attribute.set(place++, values[index]);
    attribute.compact();
  }
}

template void PointGrid::attach(const std::string&, const std::vector<float>&);
template void PointGrid::attach(const std::string&, const std::vector<double>&);
template void PointGrid::attach(const std::string&, const std::vector<std::int32_t>&);
template void PointGrid::attach(const std::string&, const std::vector<std::int64_t>&);
template void PointGrid::attach(const std::string&, const std::vector<openvdb::Vec3f>&);

openvdb::GridBase::Ptr PointGrid::grid() const { return trees_->grid; }

}  // namespace talus
