// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"
#include "common/run/hdf5_id.hpp"

namespace talus::h5 {
namespace {

/// The value of an attribute: its types in the file and in memory, and its size.
struct AttributeValue {
  hid_t file_type, memory_type, space;
  const void* data;
};

/// Write one attribute; false when HDF5 refuses.
bool write_attribute(hid_t file, const std::string& object, const std::string& name, const AttributeValue& value) {
  Id attribute(H5Acreate_by_name(file, object.c_str(), name.c_str(), value.file_type, value.space, H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT),
               H5Aclose);
  return !attribute.bad() && H5Awrite(attribute, value.memory_type, value.data) >= 0 && attribute.close();
}

}  // namespace

void File::set_text(const std::string& object, const std::string& name, const std::string& value) {
  // Fixed length, as VTK asks of its Type attribute; UTF-8 only where the text is not plain ASCII.
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  if (std::any_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) > 127; })) {
    H5Tset_cset(type, H5T_CSET_UTF8);
  }
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const char* data = value.empty() ? "\0" : value.data();
  if (!write_attribute(id_, object, name, {type, type, space, data}))
    fail(fmt::format("attribute {} {}", object, name));
}

void File::set_number(const std::string& object, const std::string& name, double value) {
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!write_attribute(id_, object, name, {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, &value})) {
    fail(fmt::format("attribute {} {}", object, name));
  }
}

void File::set_integers(const std::string& object, const std::string& name, std::span<const std::int64_t> values) {
  const hsize_t count = values.size();
  const Id space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  if (!write_attribute(id_, object, name, {H5T_STD_I64LE, H5T_NATIVE_INT64, space, values.data()})) {
    fail(fmt::format("attribute {} {}", object, name));
  }
}

namespace {

constexpr std::size_t longest_text = std::size_t{1} << 24;  // bytes; the longest that is written is a CRS

/// Whether an attribute holds one value.
bool is_single(hid_t attribute) {
  const Id space(H5Aget_space(attribute), H5Sclose);
  return !space.bad() && H5Sget_simple_extent_npoints(space) == 1;
}

}  // namespace

std::string File::text(const std::string& object, const std::string& name) const {
  const auto problem = fmt::format("attribute {} {} cannot be read", object, name);
  const Id attribute(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.bad()) fail(problem);
  const Id type(H5Aget_type(attribute), H5Tclose);
  if (type.bad() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || !is_single(attribute))
    refuse(problem, "it is not one text");
  const std::size_t size = H5Tget_size(type);
  if (size > longest_text || size > H5Aget_storage_size(attribute))
    refuse(problem, fmt::format("it claims to have {} bytes", size));
  std::string value(size, '\0');
  if (H5Aread(attribute, type, value.data()) < 0) fail(problem);
  value.resize(std::min(value.find('\0'), value.size()));
  return value;
}

namespace {

bool read_scalar(hid_t file, const std::string& object, const std::string& name, hid_t type, void* value) {
  const Id attribute(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.bad() || !is_single(attribute)) return false;
  const Id in_file(H5Aget_type(attribute), H5Tclose);
  return !in_file.bad() && same_class(in_file, type) && H5Aread(attribute, type, value) >= 0;
}

}  // namespace

double File::number(const std::string& object, const std::string& name) const {
  double value = 0;
  if (!read_scalar(id_, object, name, H5T_NATIVE_DOUBLE, &value))
    fail(fmt::format("attribute {} {} cannot be read", object, name));
  return value;
}

std::int64_t File::integer(const std::string& object, const std::string& name) const {
  std::int64_t value = 0;
  if (!read_scalar(id_, object, name, H5T_NATIVE_INT64, &value))
    fail(fmt::format("attribute {} {} cannot be read", object, name));
  return value;
}

}  // namespace talus::h5
