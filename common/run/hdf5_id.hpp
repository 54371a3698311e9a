// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the sources of common/run/hdf5.hpp share: identifiers that close themselves.
#pragma once

#include <utility>

#include <hdf5.h>

namespace talus::h5 {

/// Closes an HDF5 identifier of any kind.
class Id {
 public:
  Id(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  bool bad() const { return id_ < 0; }
  /// Close now and say whether it worked: closing may be what writes.
  bool close() { return close_(std::exchange(id_, hid_t{-1})) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Whether a type of a file is one number of the class (whole, real) of a type in memory.
inline bool same_class(hid_t in_file, hid_t in_memory) { return H5Tget_class(in_file) == H5Tget_class(in_memory); }

}  // namespace talus::h5
