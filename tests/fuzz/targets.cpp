// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The fuzz targets: what reads files, under any bytes.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/domain/domain.hpp"
#include "common/domain/level_set.hpp"
#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/gis/ascii_grid.hpp"
#include "common/gis/features.hpp"
#include "common/gis/outlines.hpp"
#include "common/run/hdf5.hpp"
#include "common/run/mobility.hpp"
#include "common/run/run_file.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "solver/run/recorders/checkpoint.hpp"
#include "solver/scene/tables.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/fuzz/target.hpp"

/// Any bytes as an accelerogram: samples later and later with finite velocities, or refused by line.
TALUS_FUZZ_TARGET(accelerogram) {
  using namespace talus::solver;
  talus::fuzz::expect_result_or_error({bytes, ".csv"}, [&](const auto& file) {
    const Shaking shaking =
        read_shaking({.file = file, .azimuth = bytes.size() % 2 == 0 ? std::optional(30.0) : std::nullopt});
    for (std::size_t n = 1; n < shaking.samples.size(); ++n)
      if (!(shaking.samples[n].time > shaking.samples[n - 1].time) ||
          !std::isfinite(talus::length(shaking.samples[n].velocity)))
        throw std::logic_error("samples that are none");
  });
}

/// Any bytes as a recipe: read with a key of every kind, or refused in words.
TALUS_FUZZ_TARGET(recipe) {
  talus::fuzz::expect_result_or_error({bytes, ".toml"}, [&](const auto& file) {
    const talus::recipe::Recipe recipe(file);
    const auto options = recipe.read<talus::test::SampleOptions>("solve");
    talus::recipe::to_toml(options, "solve", false);
  });
}

/// Any bytes as an ASCII grid: put right for GDAL, or refused by line.
TALUS_FUZZ_TARGET(ascii_grid) {
  talus::fuzz::expect_result_or_error({bytes, ".asc"}, [&](const auto& file) {
    talus::gdal::begins_as_ascii_grid(file);
    const talus::gdal::AsciiGrid grid(file);
    if (grid.is_one() && grid.path().empty()) throw std::logic_error("a grid that GDAL cannot open");
  });
}

/// Any bytes as a table of points: as many x as y as z, or refused by line.
TALUS_FUZZ_TARGET(point_table) {
  using namespace talus::preprocess;
  talus::fuzz::expect_result_or_error({bytes, ".csv"}, [&](const auto& file) {
    const ScatteredPoints points = read_point_table(file, PointHeights::depths_or_elevations);
    if (points.x.size() != points.y.size() || points.x.size() != points.z.size())
      throw std::logic_error("columns of different lengths");
  });
}

/// Any bytes as run.h5, sealed as anybody can: read, or refused in words.
TALUS_FUZZ_TARGET(run) {
  talus::fuzz::expect_result_or_error({bytes, ".h5", true}, [&](const auto& file) {
    const talus::Run run = talus::read_run(file);
    if (run.maps.terrain.size() != run.maps.grid.count()) throw std::logic_error("a map of another size");
    talus::read_motion(file, 1);
  });
}

/// Any bytes as checkpoint.h5, sealed as anybody can: lists of one length, or refused in words.
TALUS_FUZZ_TARGET(checkpoint) {
  talus::fuzz::expect_result_or_error({bytes, ".h5", true}, [&](const auto& file) {
    const std::string fingerprint = talus::h5::File::open(file, {file, ""}).text("/", "fingerprint");
    const auto checkpoint = talus::solver::read_checkpoint(file, fingerprint);
    if (checkpoint.state.points.velocity[0].size() != checkpoint.state.points.size())
      throw std::logic_error("points of different lengths");
  });
}

/// Any bytes as counts.h5 of an ensemble, sealed by whoever changed them: read, or refused in words.
TALUS_FUZZ_TARGET(counts) {
  talus::fuzz::expect_result_or_error({bytes, ".h5", true}, [&](const auto& file) {
    const talus::EnsembleCounts counts = talus::read_counts(file);
    if (counts.states.size() != static_cast<std::size_t>(counts.part.count()))
      throw std::logic_error("states of other members");
  });
}

/// Any bytes as members.h5, sealed by whoever changed them: read, or refused in words.
TALUS_FUZZ_TARGET(members) {
  talus::fuzz::expect_result_or_error({bytes, ".h5", true}, [&](const auto& file) {
    const talus::MemberTable table = talus::read_member_table(file);
    for (std::int64_t member = 0; member < std::min<std::int64_t>(table.count, 8); ++member) {
      table.values_of(member, "");
      table.name_of(member);
    }
  });
}

/// Any bytes as domain.vdb, sealed as anybody can: a domain whose points lie on its map, or refused.
TALUS_FUZZ_TARGET(domain) {
  talus::fuzz::expect_result_or_error({bytes, ".vdb", true}, [&](const auto& file) {
    const talus::Domain domain = talus::read_domain(file);
    if (domain.terrain.values.size() != domain.grid.count()) throw std::logic_error("a map of another size");
  });
}

/// Any bytes as a level set of another program: a surface of finite facets, or refused in words.
TALUS_FUZZ_TARGET(level_set) {
  talus::fuzz::expect_result_or_error({bytes, ".vdb"}, [&](const auto& file) {
    const talus::BodySurface surface = talus::read_level_set(file, "", {1, 1, 1});
    if (!std::isfinite(surface.volume)) throw std::logic_error("a body without a volume");
  });
}

namespace {

/// The next word of the bytes: its length stands in front of it.
std::string next_word(talus::fuzz::Bytes& bytes) {
  if (bytes.empty()) return {};
  const std::size_t length = std::min<std::size_t>(bytes[0] % 64, bytes.size() - 1);
  std::string word(reinterpret_cast<const char*>(bytes.data()) + 1, length);
  bytes = bytes.subspan(1 + length);
  return word;
}

double next_number(talus::fuzz::Bytes& bytes) {
  double number = 0;
  const std::size_t size = std::min(bytes.size(), sizeof number);
  if (size > 0) std::memcpy(&number, bytes.data(), size);
  bytes = bytes.subspan(size);
  return number;
}

}  // namespace

/// Any bytes as names and numbers of a GeoPackage: written and read back as the same number of polygons, or refused.
TALUS_FUZZ_TARGET(outline_attributes) {
  const talus::MapPolygon square{{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, {}, {}};
  const std::string layer = next_word(bytes), name = next_word(bytes), key = next_word(bytes);
  const double number = next_number(bytes);
  talus::fuzz::expect_result_or_error({{}, ".gpkg"}, [&](const auto& file) {
    talus::write_outlines(file, "", {{layer, {{name, {square}, {{key, number}}}}}});
    if (talus::read_polygons(file, "").size() != 1) throw std::logic_error("another number of polygons");
  });
}
