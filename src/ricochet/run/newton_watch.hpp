#pragma once

#include <string>

#include "ricochet/model/model.hpp"

/// @file Steps with very many Newton iterations, and an alternative that needs fewer.
namespace ricochet {

class NewtonWatch {
 public:
  /// Number of iterations of a step above which it has very many.
  static constexpr int many = 200;

  void persist(const SnapshotVisitor& visit);

  /// Enters a step with the seconds that it took. Returns true once per run, when steps with very many iterations have
  /// become frequent.
  [[nodiscard]] bool enter_step(int iterations, double seconds);
  /// Mean over the steps with very many iterations.
  [[nodiscard]] double seconds_per_step() const { return seconds_ / double(steps_); }
  [[nodiscard]] long steps() const { return steps_; }

 private:
  double weight_ = 0.0;  ///< number of such steps, less a fraction of the number of others
  long steps_ = 0;       ///< number of steps with very many iterations
  double seconds_ = 0.0;
  bool has_warned_ = false;
};

/// Trial of a case with the scheme that solves no system of the whole body.
struct ExplicitRun {
  std::string refusal = {};       ///< the reason why the scheme does not support the case; empty if it does
  double critical_step = 0.0;     ///< of the undeformed body
  double step = 0.0;              ///< a fraction of the critical step, which decreases where cells are compressed
  double seconds_per_step = 0.0;  ///< measured over the first steps
};
/// Builds the case anew with "semi-explicit" and "equivalent-lumped" and computes its first steps, without messages.
[[nodiscard]] ExplicitRun try_explicit(const Case& input);

/// Returns a message about steps with very many iterations; `left` is the time from now to the end of the run.
[[nodiscard]] std::string many_iterations_text(const NewtonWatch& watch, const ExplicitRun& other, double now,
                                               double left, double step);

}  // namespace ricochet
