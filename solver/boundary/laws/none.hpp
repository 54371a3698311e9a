// A bed without friction.
#pragma once

#include "solver/boundary/laws/frictionless.hpp"

namespace talus {

struct NoFriction : FrictionlessLaw<NoFriction> {
  static constexpr std::string_view name = "none";
  static constexpr bool holds = false;

  template <class All>
  static std::string words(const All&) {
    return "no friction";
  }
  template <class All>
  static std::string sentence(const All&) {
    return "no friction";
  }
};

}  // namespace talus
