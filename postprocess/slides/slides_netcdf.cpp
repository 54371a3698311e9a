// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// slides.nc: the table of the slides.
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "postprocess/ensemble/facts.hpp"
#include "postprocess/ensemble/netcdf_members.hpp"
#include "postprocess/maps/nc_grid.hpp"
#include "postprocess/slides/write_slides.hpp"

namespace talus::postprocess {

void write_slides_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                         const Options& options, const std::string& command_line) {
  const EnsembleScene& scene = ensemble.counts.scene;
  Nc nc(file);
  nc.text(NC_GLOBAL, "Conventions", "CF-1.8");
  nc.text(NC_GLOBAL, "title", scene.title + ": slides");
  nc.text(NC_GLOBAL, "institution", options.institution.empty() ? "not stated" : options.institution);
  nc.text(NC_GLOBAL, "source", "Talus " + version() + ", a run of the material point method for each slide");
  nc.text(NC_GLOBAL, "history",
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}: {}", fmt::gmtime(std::time(nullptr)), command_line));
  for (const auto& [name, words] : ensemble_facts(ensemble))
    if (name != "TITLE" && name != "SOURCE") nc.text(NC_GLOBAL, nc_lower(name).c_str(), words);
  if (!scene.grid.crs_wkt.empty()) define_crs(nc, scene.grid);
  const std::vector<int> variables = define_members(nc, rows, "slides", "slide");
  nc.end_definitions();
  fill_members(nc, variables, rows, "slides");
  write_text(file, nc.close());
}

}  // namespace talus::postprocess
