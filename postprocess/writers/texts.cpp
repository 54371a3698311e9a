// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// postprocess.used.toml, score.txt and score.json.
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

class UsedWriter : public Writer {
 public:
  std::string name() const override { return "used recipe"; }
  std::vector<std::string> names() const override { return {"postprocess.used.toml"}; }
  std::vector<std::string> outdated() const override { return {}; }
  Files write(const Job& job) const override { return {write_file(job, "postprocess.used.toml", job.used())}; }
};

class ScoreWriter : public Writer {
 public:
  std::string name() const override { return "scores"; }
  std::vector<std::string> names() const override { return {"score.json", "score.txt"}; }
  Files write(const Job& job) const override {
    return {write_file(job, "score.txt", to_table(job.score)), write_file(job, "score.json", to_json(job.score))};
  }
};

}  // namespace

std::shared_ptr<Writer> used_writer() { return std::make_shared<UsedWriter>(); }
std::shared_ptr<Writer> score_writer() { return std::make_shared<ScoreWriter>(); }

}  // namespace talus::postprocess
