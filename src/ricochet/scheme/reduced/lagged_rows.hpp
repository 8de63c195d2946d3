#pragma once

#include <memory>

#include "ricochet/contact/row_values.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/step/stage.hpp"

/// @file Lagged contact rows, for iterations that correct the error of rows which follow the motion.
namespace ricochet {

/// A contact solver keeps one solution with the factor per row, and rows that follow the motion change in every
/// iteration. An iteration that ends when nothing is left to correct may solve with earlier rows Ĥ: with the force
/// (H − Ĥ)ᵀρ of the previous reactions on its right-hand side, and gaps and slips of H at its present displacement, its
/// limit satisfies everything with H. Ĥ is renewed point by point if its relative distance from H exceeds `slack`.
///
/// The state remembers Ĥ, so that a resumed run continues with the same numbers. If rows reach other dofs as bodies
/// slide (ContactRows::sliding_state), each step begins with its own H.
class LaggedRows {
 public:
  /// Reads the rows that the state remembers, if any.
  void start(const State& state);
  /// Replaces the rows H of a stage, whose conditions are linear about the contact motion m, by Ĥ, and keeps H. Offsets
  /// are shifted such that gaps and slips at m are unchanged. The stage does not renew its rows.
  void replace_rows(const Vector& motion, Stage& stage);
  [[nodiscard]] const std::shared_ptr<const ContactRows>& exact() const { return exact_; }
  /// Releases H, which may be overwritten from now on.
  void release() { exact_ = nullptr; }
  /// Adds (H − Ĥ)ᵀρ; `tangential` is empty without friction.
  void add_difference(const Vector& normal, const Vector& tangential, Vector& force);
  void remember(State& state) const;

 private:
  static constexpr double slack = 2e-3;

  void renew();

  std::shared_ptr<ContactRows> lagged_;
  std::shared_ptr<const ContactRows> read_only_, exact_;
  PointCopier copier_;
  bool is_new_ = false;    ///< not yet in the state
  bool is_stale_ = false;  ///< of another step, not to be used
  long revision_ = 0;
  Vector motion_, negative_;  ///< work space
};

}  // namespace ricochet
