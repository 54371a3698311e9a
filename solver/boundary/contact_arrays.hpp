// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points in the memory of a device, with what they gave so far.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/boundary/contact_points.hpp"
#include "solver/boundary/contact_view.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/state/contact_state.hpp"

namespace talus::solver {

/// The arrays of the contact points: place, normal, area and body, which do not change, and the history that a
/// checkpoint keeps; all of one length.
template <class Real, class Device>
class ContactArrays {
 public:
  /// The constructor copies the points to the device, with forces and impulses from `state`; those are zero where it is
  /// empty.
  ContactArrays(const Device& device, const ContactPoints& points, const ContactState& state)
      : cell_(device),
        offset_(device),
        extent_(device),
        normal_(device),
        area_(device),
        body_(device),
        body_friction_(device),
        inverse_mass_(device),
        force_(device),
        impulse_(device) {
    for (std::size_t a = 0; a < 3; ++a) {
      cell_[a].upload(points.cell[a]);
      upload_as(offset_[a], points.offset[a]);
    }
    extent_.upload(std::vector<Real>(points.size()));
    std::vector<Vec3<Real>> normals;
    for (const Vec3<double>& n : points.normal)
      normals.push_back({static_cast<Real>(n.x), static_cast<Real>(n.y), static_cast<Real>(n.z)});
    normal_.upload(normals);
    upload_as(area_, points.area);
    body_.upload(points.body);
    upload_as(body_friction_, points.friction);
    inverse_mass_.upload(std::vector<Real>(points.size()));
    upload_vectors(force_, state.force, points.size());
    upload_vectors(impulse_, state.impulse, points.size());
  }

  /// The contact points as kernels see them.
  ContactView<Real> view() {
    ContactView<Real> v{};
    for (std::size_t a = 0; a < 3; ++a) {
      v.places.cell[a] = cell_[a].data();
      v.places.offset[a] = offset_[a].data();
      v.places.extent[a] = extent_.data();
    }
    v.normal = normal_.data();
    v.area = area_.data();
    v.body = body_.data();
    v.body_friction = body_friction_.data();
    v.inverse_mass = inverse_mass_.data();
    v.force = force_.data();
    v.impulse = impulse_.data();
    return v;
  }

  /// The impulse that every point gave to the mass so far, [points] [N s]; waits for the device.
  std::vector<Vec3<double>> impulses() const { return impulse_.download(); }

  /// The forces and impulses that a checkpoint keeps.
  ContactState state() const { return {download_vectors(force_), download_vectors(impulse_)}; }

  /// The size of the arrays [bytes].
  std::size_t bytes() const {
    std::size_t total = extent_.bytes() + normal_.bytes() + area_.bytes() + body_.bytes() + body_friction_.bytes() +
                        force_.bytes() + impulse_.bytes() + inverse_mass_.bytes();
    for (std::size_t a = 0; a < 3; ++a) total += cell_[a].bytes() + offset_[a].bytes();
    return total;
  }

 private:
  static void upload_vectors(Buffer<Vec3<double>, Device>& to, const std::vector<double>& from, std::size_t count) {
    std::vector<Vec3<double>> vectors(count);
    for (std::size_t c = 0; 3 * c + 2 < from.size() && c < vectors.size(); ++c)
      vectors[c] = {from[3 * c], from[3 * c + 1], from[3 * c + 2]};
    to.upload(vectors);
  }
  static std::vector<double> download_vectors(const Buffer<Vec3<double>, Device>& from) {
    std::vector<double> numbers;
    for (const Vec3<double>& v : from.download()) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
  }

  Buffers<int, Device, 3> cell_;
  Buffers<Real, Device, 3> offset_;
  Buffer<Real, Device> extent_;  ///< of a box without size
  Buffer<Vec3<Real>, Device> normal_;
  Buffer<Real, Device> area_;
  Buffer<int, Device> body_;
  Buffer<Real, Device> body_friction_;  ///< [obstacles]
  Buffer<Real, Device> inverse_mass_;
  Buffer<Vec3<double>, Device> force_, impulse_;
};

}  // namespace talus::solver
