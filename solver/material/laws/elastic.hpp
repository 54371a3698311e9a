// What laws without plastic flow have in common: no options or numbers of their own, and a trial that is the end.
#pragma once

#include "solver/material/law_list.hpp"
#include "solver/material/state.hpp"

namespace talus {

/// Base of an elastic law; `Law` is the law itself, so that each has its own types.
template <class Law>
struct ElasticLaw {
  static constexpr bool stiffness_is_free = false;
  using LoadedAs = Law;

  struct Options {
    void describe(recipe::Visitor&) {}
    void check(const std::string&, std::vector<Fault>&) const {}
    bool softens() const { return false; }
    bool dilates() const { return false; }
  };

  template <class Real>
  struct Numbers {
    TALUS_HD void soften(Real) {}
    void round_tip(Real) {}
    void couple_pressure(bool) {}
  };
  template <class Real>
  static Numbers<Real> numbers(const Options&, double) {
    return {};
  }

  /// The state at the end of a step whose trial strain is in `s`.
  template <class Real>
  TALUS_HD static void settle(const Elasticity<Real>&, const Numbers<Real>&, const Increment<Real>& step,
                              MaterialState<Real>& s) {
    s.elastic = step.average(s.elastic);
  }

  /// What a point goes on with of the elastic state that gravity loading gave it.
  template <class Real>
  static Sym3<Real> after_loading(const Sym3<Real>& loaded) {
    return loaded;
  }
};

}  // namespace talus
