#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/mean_reaction/reaction_path.hpp"
#include "ricochet/step/stage.hpp"

/// @file Mean ρ̄ of the reactions over a step, and with it the contact problem of a stage with massless contact nodes:
///   y = o + Z ρ̄ + U ρ,   Coulomb's law for y and ρ,
///   ρ̄ = (1−μ) ∫ ρ(τ) dτ + μ ρ,
/// where ρ(τ) are the reactions along the path (reaction_path.hpp) between q₀ = y₀ − U ρ₀ and q₁ = o + Z ρ̄. μ = 2θ − 1
/// with the least θ for which a sustained reaction does not alternate from step to step: its factor is
/// (1 − (1−θ)λ)/(1 + θλ) for an eigenvalue λ of U⁻¹Z, and may be −½ without friction, not below 0 with it.
/// docs/energy.md contains the derivation.
namespace ricochet {

class MeanReaction {
 public:
  /// Sets U and Z for candidates with these rows, and determines θ.
  void prepare(Matrix u, Matrix z, const std::vector<Index>& row_offset, ActingReaction mean);
  [[nodiscard]] double theta() const { return 0.5 * (1.0 + mu_); }
  /// Returns U + θ Z.
  [[nodiscard]] Matrix combined(double theta) const { return u_ + theta * z_; }

  /// Solves the problem. `contact` has the operator U + θ Z, and its offset is work space; o is `offset`. The start is
  /// y₀ per point and ρ₀ per row. `solve_contact` solves `contact` into `solution`, or returns false. Returns false if
  /// no mean was found, see reason().
  [[nodiscard]] bool solve(ContactProblem& contact, const Vector& offset, const Vector& start_gap, const Vector& start,
                           const std::function<bool()>& solve_contact, ContactSolution& solution);
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// True if some contact point can move at all; otherwise there are no means, and θ = 1.
  [[nodiscard]] bool is_usable() const { return usable_; }
  /// Sets the end reactions as those that act in this stage.
  void set_end_reaction(const Vector& reaction);

  /// Mean ρ̄, per row.
  [[nodiscard]] const Vector& mean() const { return acting_; }
  /// Σ r(0+) y₀ of the last stage.
  [[nodiscard]] double path_work() const { return path_work_; }
  /// ∫ρ_T·dy along the path of the last stage, y from its start.
  [[nodiscard]] double friction_work() const { return has_path_ ? path_.friction_work() : 0.0; }
  /// Weight μ of the last stage.
  [[nodiscard]] double end_weight() const { return acting_weight_; }

 private:
  [[nodiscard]] bool iterate(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                             ContactSolution& solution);
  [[nodiscard]] bool newton(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                            ContactSolution& solution);
  [[nodiscard]] bool solve_with(ContactProblem& contact, const Vector& offset,
                                const std::function<bool()>& solve_contact, ContactSolution& solution, double& error);
  [[nodiscard]] bool find_mean(const Vector& acting, const Vector& offset, const Vector& reaction, Vector& mean);
  [[nodiscard]] double difference_of(const Vector& mean, const Vector& acting) const;
  [[nodiscard]] Vector normals(const Vector& rows) const;

  Matrix u_, z_, normal_u_;
  std::vector<Index> normal_rows_, pressed_;
  ReactionPath path_;
  bool has_friction_ = false, usable_ = false;
  bool is_dependent_ = false;  ///< U is not positive definite: there are more multipliers than motions of their nodes
  double mu_ = 1.0, acting_weight_ = 1.0, path_work_ = 0.0;
  bool has_path_ = false;
  Vector q0_, q1_, friction_;
  std::vector<char> eligible_, pressing_;  ///< per point; pressing_ at the start
  AndersonAcceleration acceleration_{8};
  Vector start_gap_, start_, difference_, acting_;  ///< y₀, ρ₀, ρ̄ − θρ, ρ̄
  std::string reason_;
};

}  // namespace ricochet
