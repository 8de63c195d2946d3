#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ricochet/problem/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

/// @file The mean of the reactions over a step, ρ̄, and with it the contact problem of a stage that has a layer:
///   y = o + Z ρ̄ + U ρ,   Coulomb's law for y and ρ,
///   ρ̄_N = (1−μ) ∫ r(τ) dτ + μ ρ_N,   ρ̄_T = ρ_T,
/// where r(τ) are the normal reactions (normal_path.hpp) between q₀ = y₀ − U ρ₀ and q₁ = o + Z ρ̄ with the friction of
/// the end. μ = 2θ − 1 with the least θ for which a reaction that is held does not alternate from step to step:
/// its factor is (1 − (1−θ)λ)/(1 + θλ) for an eigenvalue λ of U⁻¹Z, and may be −½ without friction, not below 0 with
/// it. docs/energy.md derives all of it.
namespace ricochet {

class MeanReaction {
 public:
  /// For candidates with these rows: U and Z. Finds θ.
  void prepare(Matrix u, Matrix z, const std::vector<Index>& row_offset, ReactionMean mean);
  [[nodiscard]] double theta() const { return 0.5 * (1.0 + mu_); }
  /// U + θ Z.
  [[nodiscard]] Matrix combined(double theta) const { return u_ + theta * z_; }

  /// `contact` has the operator U + θ Z, and its offset is work space; o is `offset`. Start: y₀ per point, ρ₀ per row.
  /// `solve_contact` solves `contact` into `solution`, or says false. False: no mean was found, see reason().
  [[nodiscard]] bool solve(ContactProblem& contact, const Vector& offset, const Vector& start_gap, const Vector& start,
                           const std::function<bool()>& solve_contact, ContactSolution& solution);
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// U is positive definite; else there are no means, and θ = 1.
  [[nodiscard]] bool is_usable() const { return usable_; }
  /// The end reactions act in this stage.
  void take_end(const Vector& reaction);

  /// ρ̄, per row.
  [[nodiscard]] const Vector& mean() const { return acting_; }
  /// Σ r(0+) y₀ of the last stage.
  [[nodiscard]] double path_work() const { return path_work_; }
  /// μ of the last stage.
  [[nodiscard]] double end_weight() const { return acting_weight_; }

 private:
  [[nodiscard]] bool rounds(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                            ContactSolution& solution);
  [[nodiscard]] bool newton(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                            ContactSolution& solution);
  [[nodiscard]] bool solve_with(ContactProblem& contact, const Vector& offset,
                                const std::function<bool()>& solve_contact, ContactSolution& solution, double& error);
  [[nodiscard]] bool find_mean(const Vector& acting, const Vector& offset, const Vector& reaction, Vector& mean);
  [[nodiscard]] Vector normals(const Vector& rows) const;

  Matrix u_, z_, normal_u_;
  std::vector<Index> normal_rows_;
  bool has_friction_ = false, usable_ = false;
  double mu_ = 1.0, acting_weight_ = 1.0, path_work_ = 0.0;
  std::vector<char> eligible_, pressing_;           ///< per point; pressing_: at the start
  Vector start_gap_, start_, difference_, acting_;  ///< y₀, ρ₀, ρ̄ − θρ, ρ̄
  std::string reason_;
};

}  // namespace ricochet
