#pragma once

#include <array>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/dense_factor.hpp"
#include "ricochet/solver/coulomb_point.hpp"

/// @file A Newton step of the contact problem with Coulomb friction.
namespace ricochet {

struct CoulombProblem;

/// A ρ and what follows from it.
struct CoulombIterate {
  Vector reaction;            ///< ρ
  Vector motion;              ///< u = q + W ρ
  Vector size;                ///< |q| + Σ_j |W_ij ρ_j|, of which u has the rounding
  double merit = 0.0;         ///< Σ over points of the squared natural map, weighted
  double residual = 0.0;      ///< largest weighted natural map
  double beyond_floor = 0.0;  ///< largest weighted part of it beyond the rounding floor; zero: solved
  bool exact = false;         ///< it is rounding even where q is taken for exact
};

/// Newton on the equations of P. Alart and A. Curnier (Comput. Methods Appl. Mech. Engrg. 92 (1991) 353–375), as an
/// active set: with τ = (r_N − c u_N, ρ_T − c u_T) and b the friction limit of τ_N, a point is
///   open   where τ_N ≤ 0:    ρ = 0
///   stick  where |τ_T| ≤ b:  u = 0
///   slip   elsewhere:        u_N = 0, ρ_T = b t + p with t = τ_T/|τ_T|, p ⟂ t and (I − ttᵀ) u_T + (|τ_T| − b)/(b c) p
///   = 0,
/// the last being the linearisation of ρ_T = b τ_T/|τ_T| with b = F r_N, solved for the direction of slip. At a
/// solution
/// (|τ_T| − b)/(b c) = |u_T|/b ≥ 0, so that the system is W on some directions and a positive diagonal, all of its
/// rows in units of u. In two dimensions there is no p and the iteration is a finite active-set method.
class CoulombNewton {
 public:
  /// The ρ of the full step from `from`. False: the system could not be solved.
  bool step(const CoulombProblem& problem, const std::vector<CoulombPoint>& points, const CoulombIterate& from,
            Vector& reaction);
  /// With u of that ρ: what the linear system left over, once more solved for and added to ρ. False where it is
  /// rounding.
  bool refine(const CoulombIterate& full, Vector& reaction);
  void reset() { factored_.clear(); }
  /// The last step needed a new factor.
  [[nodiscard]] bool has_factored() const { return has_factored_; }

 private:
  /// A column ρ = … + x trial and a row test·u + diagonal x = 0, on the rows of one point.
  struct Unknown {
    Index first = 0, size = 0;
    std::array<double, 3> trial{}, test{};
    double diagonal = 0.0;
    double weight = 1.0;
    bool operator==(const Unknown&) const = default;
  };
  void choose(const CoulombPoint& point, const CoulombIterate& from);
  void add(const CoulombPoint& point, const PointVector& trial, const PointVector& test, double diagonal,
           double present);
  void assemble(const Matrix& operator_matrix);
  void add_proximal_term();
  [[nodiscard]] double test(const Unknown& unknown, const Vector& motion) const;
  void expand(Vector& reaction) const;

  std::vector<Unknown> unknowns_, factored_;
  Vector present_;  ///< x of the ρ the step starts from
  Vector fixed_;    ///< ρ that is not unknown: Tresca's b t
  bool has_fixed_ = false;
  Vector right_, solution_, fixed_motion_, column_;
  Matrix matrix_;
  DenseLu factor_;
  double operator_scale_ = 1.0;
  double proximal_ = 0.0;  ///< added to the diagonal of a matrix singular to rounding
  bool has_factored_ = false;
};

}  // namespace ricochet
