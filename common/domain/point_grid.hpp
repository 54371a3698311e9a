// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// An OpenVDB grid of points with attributes, as domain.vdb and the frames of a run hold it.
#pragma once

#include <openvdb/Grid.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A grid of points that is filled attribute by attribute. What it is made of is compiled once, in point_grid.cpp:
/// OpenVDB's templates for points take most of a minute.
class PointGrid {
 public:
  /// The constructor makes a grid of points at `positions` [m], sorted into the voxels of `transform`.
  PointGrid(const std::vector<openvdb::Vec3d>& positions, const openvdb::math::Transform& transform);
  ~PointGrid();
  PointGrid(const PointGrid&) = delete;
  PointGrid& operator=(const PointGrid&) = delete;

  /// The method adds an attribute with one value for each point, in the order of `positions`. Value is float, double,
  /// std::int32_t, std::int64_t or openvdb::Vec3f.
  template <class Value>
  void attach(const std::string& name, const std::vector<Value>& values);

  /// The grid, for its name, its metadata and the file.
  openvdb::GridBase::Ptr grid() const;

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

}  // namespace talus
