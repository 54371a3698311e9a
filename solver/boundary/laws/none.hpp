// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A bed without friction.
#pragma once

#include "solver/boundary/laws/frictionless.hpp"

namespace talus {

/// The law of a bed without friction.
struct NoFriction : FrictionlessLaw<NoFriction> {
  static constexpr std::string_view name = "none";
  static constexpr bool holds = false;

  /// The law in a line, for plan and log.
  template <class All>
  static std::string words(const All&) {
    return "no friction";
  }
  /// The law in a sentence of the report, "at its bed acts ...".
  template <class All>
  static std::string sentence(const All&) {
    return "no friction";
  }
};

}  // namespace talus
