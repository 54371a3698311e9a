// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A bed that holds what presses on it, whatever the force along it.
#pragma once

#include "solver/boundary/laws/frictionless.hpp"

namespace talus {

/// The law of a bed that holds what presses on it.
struct Stick : FrictionlessLaw<Stick> {
  static constexpr std::string_view name = "stick";
  static constexpr bool holds = true;

  /// The law in a line, for plan and log.
  template <class All>
  static std::string words(const All&) {
    return "held";
  }
  /// The law in a sentence of the report, "at its bed acts ...".
  template <class All>
  static std::string sentence(const All&) {
    return "no slip";
  }
};

}  // namespace talus
