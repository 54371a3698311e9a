// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Maps and tables of an error budget.
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

class SpreadWriter : public Writer {
 public:
  std::string name() const override { return "maps of spread"; }
  bool wanted(const Job& job) const override { return job.budget.has_value(); }
  std::vector<std::string> names() const override {
    std::vector<std::string> files;
    for (const std::string kind : {"", "_numerical", "_physical"})
      for (const std::string end : {".tif", ".qml"}) files.push_back("maps/deposit_spread" + kind + end);
    return files;
  }
  Files write(const Job& job) const override { return write_spread_maps(folder_of(job, "maps"), job.run, *job.budget); }
};

class BudgetWriter : public Writer {
 public:
  std::string name() const override { return "error budget"; }
  bool wanted(const Job& job) const override { return job.budget.has_value(); }
  std::vector<std::string> names() const override { return {"budget.csv", "budget.json"}; }
  Files write(const Job& job) const override {
    return {write_file(job, "budget.csv", budget_csv(*job.budget)),
            write_file(job, "budget.json", budget_json_text(*job.budget, job.run))};
  }
};

}  // namespace

std::shared_ptr<Writer> spread_writer() { return std::make_shared<SpreadWriter>(); }
std::shared_ptr<Writer> budget_writer() { return std::make_shared<BudgetWriter>(); }

}  // namespace talus::postprocess
