// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/fitted_recipe.hpp"

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "common/error.hpp"
#include "common/recipe/edited.hpp"
#include "common/stage/files.hpp"
#include "common/stage/identity.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view begins_with = "# Fitted by talus ";

}  // namespace

FittedRecipe::FittedRecipe(const Request& request, std::string command)
    : request_(request),
      command_(std::move(command)),
      file_(fs::absolute(request.recipe).lexically_normal().parent_path() / "fitted.toml") {
  if (const auto there = text_if_there(file_); there && !there->starts_with(begins_with))
    throw DataError({file_.string() + ": it is there already", command_ + " did not write it", "Give it another name"});
  if (const fs::path folder = file_.parent_path(); ::access(folder.c_str(), W_OK) != 0)
    throw DataError({file_.string() + " cannot be written", std::generic_category().message(errno),
                     "Copy the recipe into a folder of your own"});
}

fs::path FittedRecipe::write(std::vector<std::string> set, const std::vector<std::string>& lines) const {
  std::string text = text_if_there(request_.recipe).value_or("");
  if (text.starts_with(begins_with)) text.erase(0, text.find("\n\n") + 2);
  set.emplace_back("postprocess.friction_is=fitted");
  std::string above = fmt::format("# Fitted by {} (Talus {}), {}, from {}.\n", command_, version(), utc_now(),
                                  request_.recipe.filename().string());
  for (const std::string& line : lines) above += "# " + line + "\n";
  above += "# It was fitted to this event: agreement with it is no test of the friction.\n\n";
  write_text(file_, above + recipe::edited(text, set));
  return file_;
}

}  // namespace talus::command
