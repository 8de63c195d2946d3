#pragma once

#include <optional>
#include <string>

#include "ricochet/model/model.hpp"

/// @file Steps that take Newton's method very many iterations, and what takes fewer.
namespace ricochet {

class NewtonWatch {
 public:
  /// Number of iterations above which a step takes very many.
  static constexpr int many = 200;

  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// Enters a step with the seconds that it took. True once in a run, when steps of very many iterations have become
  /// usual.
  [[nodiscard]] bool enter_step(int iterations, double seconds);
  /// Mean over those that took very many iterations.
  [[nodiscard]] double seconds_per_step() const { return seconds_ / static_cast<double>(steps_); }
  [[nodiscard]] long steps() const { return steps_; }

 private:
  double weight_ = 0.0;  ///< of such steps less a part of the others'
  long steps_ = 0;       ///< with very many
  double seconds_ = 0.0;
  bool is_told_ = false;
};

/// A case under the scheme that solves no system of the whole body.
struct ExplicitRun {
  std::string refusal = {};       ///< why it does not take the case; empty: it does
  double critical_step = 0.0;     ///< of the undeformed body
  double step = 0.0;              ///< a part of it, as it falls where cells are squeezed
  double seconds_per_step = 0.0;  ///< measured, of the first steps
};
/// Builds the case anew with "semi-explicit" and "equivalent-lumped", and takes its first steps; says nothing.
[[nodiscard]] ExplicitRun try_explicit(const Case& input);

/// Message about steps of very many iterations; `left` is the time from now to the end of the run.
[[nodiscard]] std::string many_iterations_text(const NewtonWatch& watch, const ExplicitRun& other, double now,
                                               double left, double step);

}  // namespace ricochet
