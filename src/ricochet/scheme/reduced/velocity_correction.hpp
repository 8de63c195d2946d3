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
/// 1. Momenta. A residual R of the forces over the step, whose moments are those about the middle x, changes momenta by
///    h Σ R and h Σ x × R too much. Σ_k c_k P r_k with r_jᵀ M Σ_k c_k P r_k = h r_j(x)·R returns this, since
///    x₁ × M v₁ − x₀ × M v₀ = x × M (v₁−v₀) for a step with h (v₀+v₁)/2 = u₁ − u₀.
/// 2. Energy. α w is added with w the part of v₁ that is no motion of a body as a whole,
///      w = P (v₁ − Σ c_k r_k),   r_kᵀ M w = 0.
///    M α w / h is a force without resultant and moment: momenta stay exact. α is the smaller root of
///    ½ α² wᵀMw + α v₁ᵀMw = −(energy defect).
///
/// Supports that hold a body take over the resultants of R on the motions that they prevent: their forces receive
/// Σ c_k r_k instead, of the size of R. The correction of the energy does not change support reactions.
///
/// As M = m ⊗ I, the components of M P r_k are constant for translations, and for rotations they are components of the
/// product of m with positions: one product with M for bodies without supports, and a step without a correction needs
/// none.
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
  /// Computes α w at this velocity for a given change of the kinetic energy, in J. Returns false if that takes more
  /// than half of w.
  [[nodiscard]] bool find(const Vector& velocity, double change);
  /// Last change of the velocity, by either function, and M times it.
  [[nodiscard]] const Vector& value() const { return value_; }
  [[nodiscard]] const Vector& momentum() const { return momentum_; }

 private:
  static constexpr double largest_part = 0.5;
  template <int d>
  using Position = Eigen::Matrix<double, d, 1>;
  template <int d>
  using Resultant = Eigen::Matrix<double, (d == 2 ? 3 : 6), 1>;
  /// Sums over the nodes of a body of (1, x)ᵀ with the values of M P times the translations and positions.
  using MomentSums = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 9>;

  template <class Work>
  void for_each_node(const Work& work) const;
  void find_scales();
  template <int d>
  void leave_centres();
  template <int d>
  [[nodiscard]] Resultant<d> resultant(const Position<d>& position, const Position<d>& force) const;
  template <int d>
  [[nodiscard]] Position<d> position(const Vector& displacement, Index node, std::size_t body) const;
  void shift(const Vector& values, Index by, Vector& shifted) const;
  void weigh_positions();
  template <int d>
  void require_systems();
  template <int d>
  void find_system(const MomentSums& sums, SixMatrix& system) const;
  template <int d>
  void find_momenta_of_residual(const Vector& residual, const Vector& middle, double step, Vector& support_reaction);
  template <int d, class PositionOf>
  void find_resultants(const Vector& forces, const PositionOf& position_of);
  template <int d>
  void leave_to_supports(std::size_t body, const Vector& middle, Vector& support_reaction);
  template <int d>
  void remove_motions();
  template <int d>
  void add_motions(double factor);
  void mask(Vector& values) const;

  const SemidiscreteProblem& problem_;
  const BodyRotations& bodies_;
  bool has_systems_ = false;      ///< whether those of the present end are known
  Points centres_;                ///< of the bodies at the end: means of their nodes
  Vector sizes_;                  ///< numbers of nodes
  Vector scales_;                 ///< factors that make positions of the order of 1, per body
  Vector positions_;              ///< at the end, relative to the centre of the node's body, times the scale
  Vector inertia_;                ///< M P times the sum of the translations
  std::vector<Vector> weighted_;  ///< M P times positions, their components shifted by 1 and, in 3D, by 2
  Vector product_;
  Vector value_, momentum_;
  std::vector<std::vector<Index>> supports_;  ///< per body, numbers of its supported dofs in Supports::dofs()
  std::vector<MomentSums> sums_;              ///< per body
  std::vector<SixMatrix> systems_;            ///< r_jᵀ M P r_k, per body
  std::vector<SixVector> resultants_;         ///< per body
};

}  // namespace ricochet
