// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// slides.nc: the table of the slides.
#include "postprocess/ensemble/netcdf_members.hpp"
#include "postprocess/ensemble/write_slides.hpp"
#include "postprocess/maps/nc_grid.hpp"

namespace talus::postprocess {

void write_slides_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                         const Options& options, const std::string& command_line) {
  const EnsembleScene& scene = ensemble.counts.scene;
  Nc nc(file);
  describe_members_file(nc, ensemble, "slides", "a run of the material point method for each slide", options,
                        command_line);
  if (!scene.grid.crs_wkt.empty()) define_crs(nc, scene.grid);
  const std::vector<int> variables = define_members(nc, rows, "slides", "slide");
  nc.end_definitions();
  fill_members(nc, variables, rows, "slides");
  write_text(file, nc.close());
}

}  // namespace talus::postprocess
