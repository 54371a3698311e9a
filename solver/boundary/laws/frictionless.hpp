// What the laws without a friction coefficient have in common: no options, no numbers, no force that follows from slip.
#pragma once

#include "solver/boundary/slip.hpp"
#include "solver/material/law_list.hpp"

namespace talus {

/// Base of such a law; `Law` is the law itself, so that each has its own types.
template <class Law>
struct FrictionlessLaw {
  static constexpr bool rubs = false, asks_pressure = false;
  static constexpr int count = 0;

  struct Options {
    void describe(recipe::Visitor&) {}
    void check(std::vector<Fault>&) const {}
  };
  static bool uses(std::string_view) { return false; }
  template <class All>
  static void numbers(const All&, const BedSetting&, double*) {}

  template <class Real>
  TALUS_HD static Real coefficient(const Real*, const Slip<Real>&) {
    return Real(0);
  }
  template <class Real>
  TALUS_HD static Real drag(const Real*, const Slip<Real>&) {
    return Real(0);
  }
  template <class Real>
  TALUS_HD static bool drags(const Real*) {
    return false;
  }
};

}  // namespace talus
