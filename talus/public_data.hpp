// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus data: public examples, made from sources that anybody can fetch.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace talus::command {

struct DataRequest {
  std::string name;             ///< of an example; empty: list them
  std::filesystem::path out;    ///< the folder DATA, in which that of the example is made
  std::filesystem::path from;   ///< a folder that holds the sources, or the files made of them; empty: they are fetched
  bool exact = false;           ///< refuse what differs in its bytes alone, and what no checksum is known of
  std::filesystem::path table;  ///< a table of examples of one's own; empty: the one of this program
};

/// The table of examples that is part of this program (talus/public_data.toml).
std::string_view public_data_table();

/// Lists the examples with licence, repository, commit and address, or makes one of them: fetches its sources with the
/// program curl, or takes them from a folder, makes its files, compares each with what it must hold (files that were
/// there already with their SHA-256 too), and writes SOURCE.md beside them. Returns 0. Throws RecipeError, DataError.
int make_data(const DataRequest& request);

}  // namespace talus::command
