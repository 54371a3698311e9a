// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as budget.h5, sealed by whoever changed them: read, or refused in words.
#include "common/budget/budget.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(budget) {
  const talus::fuzz::InputFile file(bytes, ".h5");
  file.seal();
  talus::fuzz::expect_result_or_error([&] {
    for (const talus::BudgetRun& run : talus::read_budget(file.path()).runs)
      if (run.deposit.values.size() != run.deposit.grid.count()) throw std::logic_error("a map of another size");
  });
}
