#pragma once

#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/problem/body_rotations.hpp"

/// @file Corrections of the velocities at the end of a step (finite_strain_step.hpp): they make momenta and the balance
/// of energy exact, whatever the iterations leave.
namespace ricochet {

/// With r_k the translations and rotations of each body about its positions at the end u₁, and P the projection on the
/// dofs that are neither supported nor without inertia:
///
/// 1. Momenta. A residual R of the forces over the step, whose moments are those about the middle x, changes the
/// momenta
///    by h Σ R and h Σ x × R too much. Σ_k c_k P r_k with r_jᵀ M Σ_k c_k P r_k = h r_j(x)·R returns this, since
///    x₁ × M v₁ − x₀ × M v₀ = x × M (v₁−v₀) for a step with h (v₀+v₁)/2 = u₁ − u₀.
/// 2. Energy. α w is added with w the part of v₁ that is no motion of a body as a whole,
///      w = P (v₁ − Σ c_k r_k),   r_kᵀ M w = 0.
///    M α w / h is a force without resultant and moment: momenta stay exact. α is the smaller root of
///    ½ α² wᵀMw + α v₁ᵀMw = −(energy defect).
///
/// Supports that hold a body take over the resultants of R on the motions that they prevent: their forces receive
/// Σ c_k r_k instead, of the size of R. The correction of the energy does not change support reactions.
class VelocityCorrection {
 public:
  /// Keeps references.
  VelocityCorrection(const SemidiscreteProblem& problem, const BodyRotations& bodies);

  /// Sets the displacement at the end of the step, u₁.
  void start(const Vector& end);
  /// Computes the change of the velocity for a residual of the forces per dof, and corrects the support reactions. The
  /// residual is zero at supports.
  [[nodiscard]] const Vector& of_momenta(const Vector& residual, const Vector& middle, double step,
                                         Vector& support_reaction);
  /// Computes α w at this velocity for a given change of the kinetic energy, in J; `end` is that of start(). Returns
  /// false if that takes more than half of w.
  [[nodiscard]] bool find(const Vector& velocity, const Vector& end, double change);
  /// α w.
  [[nodiscard]] const Vector& value() const { return value_; }

 private:
  static constexpr double largest_part = 0.5;

  [[nodiscard]] int mode_count() const;
  template <class Work>
  void for_each_node(const Work& work) const;
  void find_centres(const Vector& displacement);
  void go_to(const Vector& displacement);
  [[nodiscard]] SpaceVector motion(int mode, Index node) const;
  void set_mode(int mode, Vector& values) const;
  void mask(Vector& values) const;
  void find_resultants(const Vector& forces);
  void leave_to_supports(std::size_t body, Vector& support_reaction);
  void add_motions(double factor, Vector& velocity);

  const SemidiscreteProblem& problem_;
  const BodyRotations& bodies_;
  Points centres_;    ///< of the bodies at the end: means of their nodes
  Points positions_;  ///< positions relative to the centre of the node's body
  Vector sizes_;      ///< numbers of nodes
  Vector value_, momentum_;
  std::vector<std::vector<Index>> supports_;  ///< per body, numbers of its supported dofs in Supports::dofs()
  std::vector<Vector> modes_;                 ///< P r_k of all bodies
  std::vector<SixMatrix> systems_;            ///< r_jᵀ M P r_k, per body
  std::vector<SixVector> resultants_;         ///< per body
};

}  // namespace ricochet
