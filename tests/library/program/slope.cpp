// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fifty steps of a mass on a slope, in memory: the program of docs/reference/library.md.
#include <talus/talus.hpp>

#include <cstdio>

int main() {
  const talus::MapGrid grid{.columns = 40, .rows = 20, .west = 0, .south = 0, .cell = 5, .crs_wkt = ""};
  talus::Raster bed{grid, std::vector<double>(grid.count())}, mass{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      bed.at(column, row) = 200 - 0.5 * grid.x(column);
      if (column >= 8 && column < 14 && row >= 7 && row < 13) mass.at(column, row) = 4;
    }
  const auto recipe = talus::recipe::Recipe::parse(R"(
[solve]
end_time_s = 1.0
largest_step_s = 0.02
[solve.material]
youngs_modulus_Pa = 1e6
[solve.base]
friction_angle_deg = 15.0
)");
  talus::Context context([](talus::LogLevel, const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); });
  const talus::BindContext bind(context);
  try {
    const talus::Site site{.domain = talus::make_domain(bed, mass, 2.0)};
    const talus::Result result = talus::run(talus::Plan(site, recipe), talus::On::cpu);
    double volume = 0;
    for (const double thickness : result.maps.deposit_thickness) volume += thickness * grid.cell * grid.cell;
    std::printf("%lld steps, %.3f m3\n", static_cast<long long>(result.summary.steps), volume);
  } catch (const talus::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
