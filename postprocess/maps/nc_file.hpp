// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A NetCDF file being made, what it was given, held against what it has kept, and the grid of maps in it: coordinates,
// their bounds, and the CRS as CF describes it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include "common/map/raster.hpp"
#include "common/stage/files.hpp"

namespace talus::postprocess {

/// The record of the values and attributes that went into a NetCDF file. Libraries that overlook a failed allocation
/// may lose some without a word: where memory ran out, a history was once written that differed.
class NcRecord {
 public:
  /// The place of what is written, by name: a group (empty: the file's own) and a variable there (empty: the group).
  struct Place {
    std::string group, variable;
  };

  /// The values of a block of a variable, from `start` on, `count` along each dimension; both empty: a single value.
  void values(const Place& place, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
              std::span<const double> values);
  /// The texts of a variable of one dimension.
  void texts(const Place& place, const std::vector<std::string>& texts);
  void text(const Place& place, const std::string& name, const std::string& value);
  /// An attribute that is a list of numbers, whole ones too.
  void numbers(const Place& place, const std::string& name, const std::vector<double>& values);

  /// The first thing that a file of these bytes has kept otherwise than it was given, for a message; empty: none.
  std::string difference(const std::string& bytes) const;

 private:
  /// What was written, and whether a file has it, asked by the ids of the group and of the variable there.
  struct Check {
    Place place;
    std::string what;
    std::function<bool(int group, int variable)> holds;
  };
  std::vector<Check> checks_;
};

inline constexpr double nc_fill = -9999;

/// A NetCDF file made in memory; every call is checked. In memory, because a full disk leaves the library unable to
/// close its file, and crashing: the bytes are written by write_text(), which knows what to say.
class Nc {
 public:
  explicit Nc(std::filesystem::path shown) : shown_(std::move(shown)) {
    check(nc_create_mem(shown_.filename().c_str(), NC_NETCDF4, 0, &root_), "it cannot be created");
    id_ = root_;
  }
  Nc(const Nc&) = delete;
  Nc& operator=(const Nc&) = delete;
  ~Nc() {
    if (root_ >= 0) nc_abort(root_);
  }
  /// Ends the file and returns its bytes, which have been read back: they hold all that was given.
  std::string close() {
    NC_memio image{};
    check(nc_close_memio(std::exchange(root_, -1), &image), "closing it");
    const std::unique_ptr<void, decltype(&std::free)> owner(image.memory, &std::free);
    std::string bytes(static_cast<const char*>(image.memory), image.size);
    if (const std::string difference = record_.difference(bytes); !difference.empty())
      refuse_file(shown_, "cannot be written",
                  "the NetCDF library kept something else than it was given: " + difference,
                  "Memory may have run out: free some, and run talus-postprocess again");
    return bytes;
  }

  /// Makes a group below the file's own. What follows is defined and written there, until leave_group().
  void enter_group(const char* name) {
    check(nc_def_grp(root_, name, &id_), name);
    group_ = name;
  }
  /// Goes on in the group that was left.
  void reenter_group(const char* name) {
    check(nc_inq_grp_ncid(root_, name, &id_), name);
    group_ = name;
  }
  /// Goes back to the file's own variables.
  void leave_group() {
    id_ = root_;
    group_.clear();
  }

  int dimension(const char* name, std::size_t size) {
    int dimension = 0;
    check(nc_def_dim(id_, name, size, &dimension), name);
    return dimension;
  }
  /// Defines a variable over dimensions and returns its id.
  int variable(const char* name, nc_type type, const std::vector<int>& dimensions) {
    int variable = 0;
    check(nc_def_var(id_, name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable), name);
    return variable;
  }
  /// A map (or maps over time): chunked by map, compressed, with fill value.
  int field(const char* name, const std::vector<int>& dimensions) {
    const int id = variable(name, NC_DOUBLE, dimensions);
    std::vector<std::size_t> chunk = lengths_of(id);
    for (std::size_t d = 0; d < chunk.size(); ++d)
      chunk[d] = d + 2 < chunk.size() ? 1 : std::min<std::size_t>(chunk[d], 512);
    check(nc_def_var_chunking(id_, id, NC_CHUNKED, chunk.data()), name);
    check(nc_def_var_deflate(id_, id, 1, 1, 4), name);
    check(nc_def_var_fill(id_, id, NC_FILL, &nc_fill), name);
    return id;
  }
  /// Sets an attribute that is text; NC_GLOBAL as the variable sets one of the file.
  void text(int variable, const char* name, const std::string& value) {
    check(nc_put_att_text(id_, variable, name, value.size(), value.data()), name);
    record_.text(place(variable), name, value);
  }
  void numbers(int variable, const char* name, const std::vector<double>& values) {
    check(nc_put_att_double(id_, variable, name, NC_DOUBLE, values.size(), values.data()), name);
    record_.numbers(place(variable), name, values);
  }
  /// Sets an attribute that is a list of whole numbers.
  void integers(int variable, const char* name, const std::vector<int>& values) {
    check(nc_put_att_int(id_, variable, name, NC_INT, values.size(), values.data()), name);
    record_.numbers(place(variable), name, {values.begin(), values.end()});
  }
  void put_texts(int variable, const std::vector<std::string>& texts) {
    std::vector<const char*> begins;
    for (const std::string& text : texts) begins.push_back(text.c_str());
    check(nc_put_var_string(id_, variable, begins.data()), "texts");
    record_.texts(place(variable), texts);
  }
  void put(int variable, const std::vector<double>& values) {
    const std::vector<std::size_t> count = lengths_of(variable);
    put_block(variable, std::vector<std::size_t>(count.size(), 0), count, values);
  }
  /// Writes the values of one map, of those that follow one another in time or by another coordinate.
  void put_map(int variable, std::size_t time, const std::vector<double>& values) {
    std::vector<std::size_t> start = lengths_of(variable), count = start;
    std::fill(start.begin(), start.end(), 0);
    start[0] = time;
    count[0] = 1;
    put_block(variable, start, count, values);
  }
  void end_definitions() { check(nc_enddef(root_), "header"); }

 private:
  void put_block(int variable, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                 const std::vector<double>& values) {
    check(nc_put_vara_double(id_, variable, start.data(), count.data(), values.data()), "values");
    record_.values(place(variable), start, count, values);
  }
  NcRecord::Place place(int variable) {
    char name[NC_MAX_NAME + 1] = "";
    if (variable != NC_GLOBAL) check(nc_inq_varname(id_, variable, name), "variable");
    return {group_, name};
  }
  std::vector<std::size_t> lengths_of(int variable) {
    int rank = 0;
    check(nc_inq_varndims(id_, variable, &rank), "dimensions");
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    check(nc_inq_vardimid(id_, variable, dimensions.data()), "dimensions");
    std::vector<std::size_t> lengths(dimensions.size());
    for (std::size_t d = 0; d < dimensions.size(); ++d)
      check(nc_inq_dimlen(id_, dimensions[d], &lengths[d]), "dimensions");
    return lengths;
  }
  void check(int status, const char* doing) {
    if (status != NC_NOERR) throw DataError(write_fault(shown_, fmt::format("{}: {}", doing, nc_strerror(status))));
  }

  std::filesystem::path shown_;
  int root_ = -1;
  int id_ = -1;        ///< the file itself, or the group that was entered
  std::string group_;  ///< its name; empty: the file itself
  NcRecord record_;
};

/// Attributes of a CF grid_mapping variable (CF-1.8, appendix F).
struct CfProjection {
  std::string grid_mapping_name;  ///< empty: a projection CF has no name for
  std::vector<std::pair<std::string, std::vector<double>>>
      numbers;  ///< parameters, angles in degrees, lengths in metres
  /// Names of the CRS, its geographic CRS, datum, ellipsoid and prime meridian: all of them or none, as CF asks.
  std::vector<std::pair<std::string, std::string>> words;
};

/// The attributes of a CRS; an empty name of projections not in CF's appendix, of which readers know the crs_wkt.
CfProjection cf_projection(const std::string& wkt);

struct NcAxis {
  int dimension = -1, variable = -1, bounds = -1;
};
struct NcAxes {
  NcAxis x, y;
};

/// Defines dimensions y and x with their coordinates and bounds.
NcAxes define_axes(Nc& nc, const MapGrid& grid);

/// Defines the variable crs, by the names of CF and those of GDAL.
void define_crs(Nc& nc, const MapGrid& grid);

/// Defines the variable time, in seconds since `start`; empty: not known, a nominal date stands for it.
int define_time(Nc& nc, int dimension, const std::string& start);

/// Writes coordinates and bounds.
void fill_axes(Nc& nc, const NcAxes& axes, const MapGrid& grid);

/// Attributes of a file: Conventions, title, institution ("not stated" where it is empty), source, history.
void describe_file(Nc& nc, const std::string& title, const std::string& institution, const std::string& source,
                   const std::string& command_line);

/// A text in lower case, as attributes are.
std::string lower_case(std::string text);

/// Letters, digits and underscores, as CF asks of names.
std::string nc_name(std::string name);

}  // namespace talus::postprocess
