#pragma once

#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/scheme/contact_status.hpp"
#include "ricochet/solver/coulomb_newton.hpp"
#include "ricochet/solver/coulomb_point.hpp"

/// @file The contact problem with Coulomb friction on the condensed operator. Knows nothing of finite elements or time.
namespace ricochet {

/// Point i has the rows first[i] … first[i+1]−1: its normal, then (if it has friction) its d−1 tangents. Find ρ with
/// ρ_i = (r_N, −r_T) and u = q + W ρ such that for every eligible point
///   0 ≤ r_N ⟂ u_N ≥ 0,   |r_T| ≤ b,   r_T = b u_T/|u_T| where u_T ≠ 0,
/// with b = F r_N (Coulomb, bound = 0), b = min(F r_N, bound) (Coulomb's law with a limit), or b = bound where r_N > 0
/// and b = 0 where r_N = 0 (Tresca, F = 0 < bound); ρ_i = 0 for the others. W is symmetric positive definite. The disc
/// |r_T| ≤ b is the disc itself, no polygon.
///
/// Tresca's b jumps at r_N = 0, and a solution need not exist then: friction can hold up a point that would penetrate
/// without it. The law is closed there: at a grazing point (r_N = 0 = u_N) any b in [0, bound] is admitted, the limit
/// of b = min(bound, k r_N) for k → ∞.
struct CoulombProblem {
  const Matrix* operator_matrix = nullptr;       ///< W
  const Vector* offset = nullptr;                ///< q, per row
  const Vector* offset_rounding = nullptr;       ///< size of the rounding error of q, per row
  const std::vector<Index>* first = nullptr;     ///< points + 1
  const std::vector<char>* eligible = nullptr;   ///< per point
  const Vector* friction_coefficient = nullptr;  ///< F, per point
  const Vector* friction_bound = nullptr;        ///< per point, in units of ρ; 0: none
};

struct CoulombSolution {
  Vector reaction;  ///< ρ, per row; r_N never negative, ρ_i exactly zero where open. Not a solution unless solved
  /// Per point. closed: F = 0 and no bound. stick: |r_T| < b, or u_T is rounding. slip: |r_T| = b to rounding.
  std::vector<ContactStatus> status;
  int iterations = 0;      ///< Newton steps and sweeps
  int newton_steps = 0;    ///< of them, those with a linear system
  int factorizations = 0;  ///< of those, the ones that could not use the factor of an earlier step
  /// Largest natural-map residual of a point over the size of the data (below): at most 1e-12 beyond rounding if
  /// solved.
  double residual = 0.0;
  bool solved = false;
  const char* reason = "";  ///< why not, when not solved
};

/// Non-smooth Newton after projected block Gauss–Seidel.
///
/// 1. ρ = 0 is returned at once where it is a solution.
/// 2. From the last ρ, a few sweeps of projected block Gauss–Seidel: each active or violated point is solved
///    exactly for the others' reactions. First order, robust; it finds the contact and the directions of slip roughly.
/// 3. Newton on the Alart–Curnier equations, see CoulombNewton, each step cut back until the natural map decreases
///    (sum of squares over points); where no part of a step does, a run of whole steps from the best ρ so far.
/// 4. Where Newton stalls, more sweeps from the best ρ so far, then Newton again, twice as many sweeps every time.
///    At last the same from ρ = 0, with sweeps that take a half, a quarter, an eighth of each point's correction, and
///    whole ones for as long as they come closer.
///
/// Stopping test, the only one: at each point the natural map
///   e_N = min(u_N, r_N/c),  e_T = (ρ_T − P_b(ρ_T − c u_T))/c,  c ≈ 1/W_ii,  P_b the projection on the disc |·| ≤ b,
/// is below its rounding floor offset_rounding + 32 ε (|q| + Σ_j |W_ij ρ_j|), the largest of the point's rows. When
/// nothing improves any more, a residual below floor + 1e-12 of the data's size (largest |q_i| in units in which each
/// W_ii is about 1) is accepted too; a larger one never.
///
/// What is guaranteed. For symmetric positive definite W a solution of Coulomb's law exists for every F ≥ 0 and every
/// q. It is unique for F below a bound that depends on W (always, for F = 0); beyond it there can be several or
/// infinitely many, and the one returned is that which the iteration finds from the previous step's ρ: deterministic,
/// but dependent on history. What is returned as solved satisfies the law to rounding, whatever F. That a solution is
/// found is not guaranteed, for no method known finds one for every F in reasonable time: of random W with strong
/// coupling of normal and tangential motion none was missed for F ≤ 3, and up to one in 100 for F from 10 to 100; then
/// `reason` says so. Under Tresca's law the jump of the bound where a point opens can leave only solutions that balance
/// on the jump, which the iteration does not find (up to one in 30 of such problems with a bound as large as the normal
/// reactions). Where W is only semi-definite (conditions that depend on one another) a solution is found if one exists;
/// then u is determined, the reactions are not.
///
/// Nothing depends on the unit system: comparisons are between like quantities and scale factors are powers of two.
class CoulombSolver {
 public:
  void solve(const CoulombProblem& problem, CoulombSolution& solution);
  /// Forgets the warm start and the factor. Call it before a problem with another operator: a factor may be used again.
  void reset();
  /// The last ρ, where the next solve starts; for a checkpoint. Empty: zero. A run resumed from it gives the same bits:
  /// a factor used again is the one that would be computed.
  [[nodiscard]] const Vector& warm_start() const { return warm_start_; }
  void set_warm_start(Vector reaction);

 private:
  void prepare(const CoulombProblem& problem);
  [[nodiscard]] bool is_open(const CoulombProblem& problem) const;
  void start(const CoulombProblem& problem);
  void evaluate(const CoulombProblem& problem, CoulombIterate& iterate) const;
  void measure(const CoulombProblem& problem, CoulombIterate& iterate) const;
  bool iterate(const CoulombProblem& problem, CoulombSolution& solution);
  bool sweep_on(const CoulombProblem& problem, CoulombSolution& solution);
  bool alternate(const CoulombProblem& problem, int sweeps, int rounds, CoulombSolution& solution);
  bool sweep(const CoulombProblem& problem, int sweeps, CoulombSolution& solution);
  bool newton(const CoulombProblem& problem, bool line_search, CoulombSolution& solution);
  bool search_line(const CoulombProblem& problem);
  bool finish(const CoulombProblem& problem, CoulombSolution& solution);
  bool polish(const CoulombProblem& problem, CoulombSolution& solution);
  [[nodiscard]] ContactStatus status_of(const CoulombProblem& problem, const CoulombPoint& point) const;

  std::vector<CoulombPoint> points_;  ///< the eligible ones
  double data_size_ = 0.0;
  double damping_ = 1.0;  ///< part of a point's correction that a sweep takes
  CoulombNewton newton_;
  CoulombIterate current_, trial_, cut_, best_, fallback_;
  std::vector<char> sweep_status_;
  Vector warm_start_;
};

}  // namespace ricochet
