#pragma once

#include <memory>

#include "ricochet/problem/internal_force.hpp"

/// @file Springs between dofs and the ground.
namespace ricochet {

/// Sum of another internal force and of k_i u_i at some dofs on which the other does not act (those of rigid bodies).
class GroundSprings final : public InternalForce {
 public:
  /// Adds springs to `bodies`; `stiffness`: k per dof.
  GroundSprings(std::shared_ptr<const InternalForce> bodies, const Vector& stiffness);
  void evaluate(const Vector& displacement, Vector& force) const override;
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] double energy(const Vector& displacement, const Vector& force) const override;
  void path_force(const Vector& middle, const Vector& increment, const PathRules& rules, Vector& force) const override;
  [[nodiscard]] SparseMatrix path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                          const PathVariation& variation) const override;
  [[nodiscard]] PathRules path_rules() const override { return bodies_->path_rules(); }
  [[nodiscard]] double estimated_seconds() const override { return bodies_->estimated_seconds(); }
  bool raise_path_rules(const Vector& middle, const Vector& increment, PathRules& rules) const override {
    return bodies_->raise_path_rules(middle, increment, rules);
  }
  [[nodiscard]] std::shared_ptr<const InternalForce> restricted_to(const std::vector<char>& nodes) const override {
    return bodies_->restricted_to(nodes);
  }
  void add_ground_force(const Vector& displacement, Vector& force) const override { add(displacement, force); }
  [[nodiscard]] const ViscousForce* viscous() const override { return bodies_->viscous(); }
  [[nodiscard]] const DistortionForce* distortion() const override { return bodies_->distortion(); }
  [[nodiscard]] bool is_linear() const override { return bodies_->is_linear(); }
  [[nodiscard]] double energy_terms(const Vector& displacement) const override {
    return bodies_->energy_terms(displacement) + 2.0 * own_energy(displacement);
  }
  using InternalForce::tangent;
  [[nodiscard]] SparseMatrix tangent(const Vector& displacement) const override;

 private:
  void add(const Vector& displacement, Vector& force) const;
  [[nodiscard]] SparseMatrix with_springs(const SparseMatrix& of_bodies, double factor) const;
  [[nodiscard]] double own_energy(const Vector& displacement) const;

  std::shared_ptr<const InternalForce> bodies_;
  std::vector<std::pair<Index, double>> springs_;  ///< dof and stiffness
};

}  // namespace ricochet
