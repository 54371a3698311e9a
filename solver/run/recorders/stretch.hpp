// Recorder of points that are stretched beyond what their law bears: no tearing in silence.
#pragma once

#include "solver/options/solve.hpp"
#include "solver/run/recorders/recorder.hpp"

namespace talus::solver {

/// The points beyond the stretch from which the nominal stress of their law falls (Law::largest_strain), so that they
/// are torn apart by the law and not by a strength.
struct Overstretched {
  double points = 0;   ///< how many [-]
  double largest = 0;  ///< stretch of any point of such a law [-]
};

/// The recorder that counts them at each record. Scenes without such a law have none; with one a record takes the
/// points from the device.
class StretchRecorder : public TableRecorder<Overstretched> {
 public:
  explicit StretchRecorder(const SolveOptions& options);
  /// Whether some material of the scene has such a law.
  static bool watches(const SolveOptions& options);
  /// What to say where points have gone beyond it; none where none has.
  std::vector<std::string> warnings(const RunHistory& history) const override;

 protected:
  std::vector<Overstretched> samples(const Instant& now) const override;

 private:
  std::vector<double> limits_;  ///< largest principal logarithmic strain of every material [-]
};

}  // namespace talus::solver
