// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/costs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "common/recipe/toml.hpp"

namespace talus::validation {

long cost_bound(long recorded) { return std::lround(std::ceil(1.15 * static_cast<double>(recorded))) + 2; }

CostBook read_costs(const std::filesystem::path& file) {
  CostBook book;
  if (!std::filesystem::exists(file)) return book;
  try {
    const toml::table table = toml::parse_file(file.string());
    for (const auto& [run, value] : table) {
      const toml::array* numbers = value.as_array();
      long found[3] = {-1, -1, -1};
      for (std::size_t n = 0; numbers && numbers->size() == 3 && n < 3; ++n)
        found[n] = static_cast<long>(numbers->get(n)->value_or<std::int64_t>(-1));
      if (found[0] < 0 || found[1] < 0 || found[2] < 0)
        throw std::runtime_error(
            fmt::format("{}: \"{}\" is not [steps, Newton iterations, linear iterations]. "
                        "talus-validate --record-costs writes such lines",
                        file.string(), std::string(run.str())));
      book[std::string(run.str())] = {found[0], found[1], found[2]};
    }
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), error.source().begin.line, error.description()));
  }
  return book;
}

std::string as_toml(const CostBook& book) {
  std::string text =
      "# What the runs of the validation have cost: steps, Newton iterations, linear iterations. A run may cost 15 % "
      "and\n"
      "# two more; rows of the table say so. Written by talus-validate --record-costs, which keeps the runs that it "
      "does\n"
      "# not make.\n";
  for (const auto& [run, cost] : book)
    text += fmt::format("\"{}\" = [{}, {}, {}]\n", run, cost.steps, cost.newton, cost.linear);
  return text;
}

}  // namespace talus::validation
