#pragma once

#include <optional>

#include "ricochet/fem/distortion_control.hpp"
#include "ricochet/problem/distortion_force.hpp"
#include "ricochet/problem/viscous_force.hpp"

/// @file Internal force of bodies with at least one material of finite strain.
namespace ricochet {

class FiniteElasticity final : public InternalForce, public ViscousForce, public DistortionForce {
 public:
  /// Keeps a reference to the body and to its ties.
  FiniteElasticity(const Body& body, NodeGraph graph);

  /// Restricts the force to some cells.
  FiniteElasticity(const Body& body, NodeGraph graph, std::vector<int> cells,
                   std::shared_ptr<bool> controls_distortion);

  void evaluate(const Vector& displacement, Vector& force) const override;
  void path_force(const Vector& middle, const Vector& increment, const PathRules& rules, Vector& force) const override;
  [[nodiscard]] SparseMatrix path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                          const PathVariation& variation) const override;
  [[nodiscard]] PathRules path_rules() const override;
  [[nodiscard]] double estimated_seconds() const override;
  bool raise_path_rules(const Vector& middle, const Vector& increment, PathRules& rules) const override;
  using InternalForce::energy;
  [[nodiscard]] double energy(const Vector& displacement) const override;
  [[nodiscard]] std::shared_ptr<const InternalForce> restricted_to(const std::vector<char>& nodes) const override;
  [[nodiscard]] bool is_linear() const override { return false; }
  using InternalForce::tangent;
  [[nodiscard]] SparseMatrix tangent(const Vector& displacement) const override;

  [[nodiscard]] const ViscousForce* viscous() const override { return internal_size() > 0 ? this : nullptr; }
  [[nodiscard]] Index internal_size() const override { return cells_.internal_size(); }
  void relax(const Vector& displacement, Vector& internal) const override;
  [[nodiscard]] double branch_energy(const Vector& displacement, const Vector& internal) const override;
  void add_mean_force(const BranchStep& step, Vector& force) const override;
  void add_end_force(const BranchStep& step, Vector& force) const override;
  [[nodiscard]] double start_energy(const BranchStep& step, const Vector& displacement) const override;
  [[nodiscard]] double advance_internal(const BranchStep& step, Vector& internal) const override;
  [[nodiscard]] SparseMatrix step_tangent(const Vector& displacement, double step) const override;
  [[nodiscard]] SparseMatrix step_path_tangent(const BranchStep& step, const PathRules& rules,
                                               const PathVariation& variation) const override;

  [[nodiscard]] const DistortionForce* distortion() const override { return control_ ? this : nullptr; }
  [[nodiscard]] CellVolume smallest_nodal_volume(const Vector& displacement) const override;
  void control_distortion(bool is_on) const override { *controls_distortion_ = is_on; }
  [[nodiscard]] double distortion_energy(const Vector& displacement) const override;

 private:
  /// Fills in the values of the tied nodes.
  const Vector& complete(const Vector& values, Vector& memory) const;
  void condense(Vector& force) const;
  [[nodiscard]] SparseMatrix condensed(SparseMatrix general) const;
  void require_positive_volume(const CellVolume& smallest) const;
  /// The control if it is on, else null.
  [[nodiscard]] const DistortionControl* control() const { return *controls_distortion_ ? &*control_ : nullptr; }

  const Body& body_;
  NodeGraph graph_;
  ElasticCells cells_;
  std::optional<DistortionControl> control_;
  std::shared_ptr<bool> controls_distortion_;  ///< the same for all restrictions of a force
  [[nodiscard]] BranchStep complete(const BranchStep& step) const;
  void add_branches(Vector& force) const;

  mutable Vector displacement_, increment_, start_, end_, at_, branches_;
};

}  // namespace ricochet
