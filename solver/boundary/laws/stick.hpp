// A bed that holds what presses on it, whatever the force along it.
#pragma once

#include "solver/boundary/laws/frictionless.hpp"

namespace talus {

struct Stick : FrictionlessLaw<Stick> {
  static constexpr std::string_view name = "stick";
  static constexpr bool holds = true;

  template <class All>
  static std::string words(const All&) {
    return "held";
  }
  template <class All>
  static std::string sentence(const All&) {
    return "no slip";
  }
};

}  // namespace talus
