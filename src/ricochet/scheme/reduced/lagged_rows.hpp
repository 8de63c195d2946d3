#pragma once

#include <memory>
#include <string>

#include "ricochet/contact/row_values.hpp"
#include "ricochet/problem/stage.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Rows that follow the motion, for iterations that correct what is wrong with them.
namespace ricochet {

/// A contact solver keeps a solution of the factor for every row, and rows that follow the motion are new in every
/// iteration. An iteration that ends where nothing is left to correct may solve with rows Ĥ of before: with the force
/// (H − Ĥ)ᵀρ of the reactions before on its right-hand side, and gaps and slips of H where it stands, it ends where
/// H has it all. Ĥ is made new point by point where H is off it by more than `slack` of it.
///
/// The state remembers Ĥ, so that a run that is resumed goes on with the same numbers. Where rows reach other dofs as
/// bodies slide (ContactRows::places), each step begins with its own H.
class LaggedRows {
 public:
  /// Those that the state remembers, if any.
  void start(const State& state);
  /// Ĥ becomes the rows of a stage whose conditions are linear about the contact motion m, with rows H, which are kept:
  /// offsets are such that gaps and slips at m stay what they are. The stage takes no rows anew.
  void take_over(const Vector& motion, Stage& stage);
  [[nodiscard]] const std::shared_ptr<const ContactRows>& exact() const { return exact_; }
  /// Others may write H from now on.
  void let_go() { exact_ = nullptr; }
  /// Adds (H − Ĥ)ᵀρ; without friction `tangential` is empty.
  void add_difference(const Vector& normal, const Vector& tangential, Vector& force);
  void remember(State& state) const;

 private:
  static constexpr double slack = 2e-3;

  void renew();

  std::shared_ptr<ContactRows> lagged_;
  std::shared_ptr<const ContactRows> read_only_, exact_;
  PointCopier copier_;
  bool is_new_ = false;    ///< not yet remembered
  bool is_stale_ = false;  ///< of another step, and not to be used
  long revision_ = 0;
  Vector motion_, negative_;  ///< work space
};

}  // namespace ricochet
