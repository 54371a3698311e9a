// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The visitor that looks at what options need of one another, once they have been read.
#include "common/recipe/recipe.hpp"

namespace talus::recipe {
namespace {

class Checker : public Visitor {
 public:
  explicit Checker(std::vector<Fault>& faults) : faults_(faults) {}
  void needs(bool met, const Fault& otherwise) override {
    if (!met) faults_.push_back(otherwise);
  }

  void enter(std::string_view, std::string_view) override {}
  void leave() override {}
  void number(std::string_view, double&, Range, std::string_view) override {}
  void optional_number(std::string_view, std::optional<double>&, Range, std::string_view) override {}
  void integer(std::string_view, int&, Range, std::string_view) override {}
  void flag(std::string_view, bool&, std::string_view) override {}
  void text(std::string_view, std::string&, std::string_view) override {}
  void path(std::string_view, std::filesystem::path&, std::string_view) override {}
  void numbers(std::string_view, std::vector<double>&, Range, std::string_view) override {}
  void integers(std::string_view, std::vector<int>&, Range, std::string_view) override {}
  void one_of(std::string_view, int&, const std::vector<std::string_view>&, std::string_view) override {}
  std::size_t begin_list(std::string_view, std::size_t size, std::string_view) override { return size; }
  void begin_item(std::size_t) override {}
  void end_item() override {}
  void end_list() override {}

 private:
  std::vector<Fault>& faults_;
};

}  // namespace

std::unique_ptr<Visitor> make_checker(std::vector<Fault>& faults) { return std::make_unique<Checker>(faults); }

}  // namespace talus::recipe
