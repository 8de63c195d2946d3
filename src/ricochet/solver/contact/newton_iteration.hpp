#pragma once

#include <array>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/dense_factor.hpp"
#include "ricochet/linear_algebra/sparse_lu.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

/// @file Semismooth Newton method on an equation per point.
namespace ricochet {

/// Equation f_i(u_i, r_i) = 0, which states that point i satisfies its law. In units of r. Components of missing
/// tangents are zero, except for ones on the diagonal of ∂f/∂r.
struct PointEquation {
  PaddedVector value = PaddedVector::Zero();
  Eigen::Matrix3d by_motion = Eigen::Matrix3d::Zero();        ///< an element of ∂f/∂u
  Eigen::Matrix3d by_reaction = Eigen::Matrix3d::Identity();  ///< the corresponding one of ∂f/∂r
};

/// Normal reaction that determines the friction limit b of the projection equations.
enum class DiscRadius { of_trial, of_reaction };
/// Returns f_N = r_N − max(0, τ_N), f_T = r_T − P_b(τ_T) with τ = r − u/w, P_b the projection on the disc |·| ≤ b.
[[nodiscard]] PointEquation projection_equation(const ContactPoint& point, const PaddedVector& reaction,
                                                const PaddedVector& motion, DiscRadius radius, bool derivatives);

/// Linear system of a step, (A W + B) Δr = −f with A and B block diagonal, W dense or sparse. Points with A_i = 0 (open
/// ones) are eliminated for a dense W.
class NewtonSystem {
 public:
  /// Returns false if the matrix is singular.
  bool solve(const ContactSystem& system, const std::vector<PointEquation>& equations, Vector& change);
  /// To be called for another W.
  void reset() { pattern_ = nullptr; }

 private:
  bool solve_dense(const ContactSystem& system, const std::vector<PointEquation>& equations, Vector& change);
  bool solve_sparse(const ContactSystem& system, const std::vector<PointEquation>& equations, Vector& change);
  void assemble_dense(const ContactSystem& system, const std::vector<PointEquation>& equations);
  void find_pattern(const ContactSystem& system);

  std::vector<std::size_t> active_;  ///< points with A_i ≠ 0
  std::vector<Index> start_;         ///< their first rows in the matrix
  Matrix matrix_;
  DenseLu factor_;
  Vector right_, solution_, fixed_motion_;
  const SparseMatrix* pattern_ = nullptr;              ///< W whose pattern `sparse_matrix_` has
  std::vector<std::size_t> point_of_, last_point_of_;  ///< per row of W: its point, or none
  SparseMatrix sparse_matrix_;
  SparseLu sparse_factor_;
};

/// Newton's method from a given r, each step cut back until ½ Σ w_i |f_i|² is below the largest of its last few values
/// (L. Grippo, F. Lampariello, S. Lucidi, SIAM J. Numer. Anal. 23 (1986) 707–716): the equations have kinks, at which a
/// merit that must fall at every step stagnates. If no part of a step passes, the full one is taken, a few times per
/// solve: an active set may have to pass through a large residual.
class NewtonContactSolver : public IterativeContactSolver {
 protected:
  /// Returns f of a point and, with `derivatives`, its derivatives.
  [[nodiscard]] virtual PointEquation equation(const ContactPoint& point, const PaddedVector& reaction,
                                               const PaddedVector& motion, bool derivatives) const = 0;
  /// Computes r of the full step from `from`. Returns false if its system is singular.
  virtual bool full_step(const ContactSystem& system, const ContactIterate& from, Vector& reaction,
                         ContactSolution& solution);
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override;
  void forget() override { linear_system_.reset(); }
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override;

 private:
  static constexpr std::size_t memory = 5;
  [[nodiscard]] double merit(const ContactSystem& system, const ContactIterate& iterate) const;
  bool search_line(const ContactSystem& system, ContactIterate& current, double reference);

  NewtonSystem linear_system_;
  std::vector<PointEquation> equations_;
  Vector change_;
  ContactIterate trial_, cut_, best_;
  double merit_ = 0.0;                   ///< of the present iterate
  std::array<double, memory> merits_{};  ///< of the last ones
};

}  // namespace ricochet
