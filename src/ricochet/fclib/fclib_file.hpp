#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_solver.hpp"

/// @file Contact problems in the HDF5 layout of FCLib, the field's collection of frictional contact problems (V. Acary,
/// M. Brémond, T. Koziara, F. Pérignon, "FCLIB: a collection of discrete 3D Frictional Contact problems", INRIA
/// RT-0444, 2014). The unknowns of a local problem are u, r and the multipliers λ of equality constraints with
///   u = W r + V λ + q,   0 = Vᵀ r + R λ + s,   K* ∋ û ⟂ r ∈ K,   û = u + [μ|u_T|, 0, 0],   K = {|r_T| ≤ μ r_N}
/// at every point, its normal component first: the same statement, with the same signs, as ContactProblem's.
///
///   /fclib_local/spacedim                  2 or 3
///   /fclib_local/W, V, R                   nzmax, m, n, nz, p, i, x; V and R together or not at all
///   /fclib_local/vectors/q, mu, s          s with V and R
///   /fclib_local/info/title, description, math_info   texts, all optional
///   /fclib_local/info/points               ours: the numbers of the points in the original problem
///   /fclib_local/info/q_rounding           ours: per row, size of the rounding error of q
///   /solution/u, r, l                      l with V and R
///   /guesses/number_of_guesses, 1/u, 1/r, 1/l, 2/…
namespace ricochet {

/// Storage of a matrix in a file, by FCLib's `nz`.
enum class FclibMatrixForm {
  triplet,             ///< nz ≥ 0 entries: p rows, i columns, x values; duplicates are summed
  compressed_columns,  ///< nz = −1: p column starts, i rows
  compressed_rows,     ///< nz = −2: p row starts, i columns
};

struct FclibSolution {
  Vector motion;      ///< u, per row
  Vector reaction;    ///< r, per row
  Vector multiplier;  ///< λ, per equality constraint
};

/// Contents of a file.
struct FclibProblem {
  std::string path;     ///< path of the file that was read, for messages
  Index dimension = 3;  ///< rows per point
  SparseMatrix w;       ///< symmetric: see read_fclib
  SparseMatrix v, r;    ///< rows × constraints, constraints × constraints; without constraints: rows × 0 and 0 × 0
  Vector q, mu, s;      ///< per row, per point, per constraint
  std::string title, description, math_info;
  std::vector<Index> points;  ///< numbers in the original problem; empty if unknown
  Vector q_rounding;          ///< per row, size of the rounding error of q; empty if unknown
  std::optional<FclibSolution> solution;
  std::vector<FclibSolution> guesses;

  [[nodiscard]] Index point_count() const { return mu.size(); }
  [[nodiscard]] Index constraint_count() const { return r.rows(); }
};

/// Reads a local problem. W and R must be symmetric: |W_ij − W_ji| ≤ 10⁻⁸ √(W_ii W_jj) counts as rounding, and their
/// symmetric parts are kept. The diagonal of W must not be negative. Throws Error(file_access) if the file cannot be
/// opened, and Error(invalid_input) with file, data set and value for every error in it.
[[nodiscard]] FclibProblem read_fclib(const std::string& path);

/// Writes a file that read_fclib and FCLib itself can read; an existing one is replaced when the new one is complete.
/// Throws Error(file_access).
void write_fclib(const std::string& path, const FclibProblem& problem,
                 FclibMatrixForm form = FclibMatrixForm::compressed_columns);

/// Problem with its equality constraints eliminated:
///   λ = −R⁻¹ (Vᵀ r + s),   u = (q − V R⁻¹ s) + (W − V R⁻¹ Vᵀ) r.
struct FclibReduction {
  ContactProblem problem;    ///< W dense if more than a third of its entries are present
  Matrix multiplier_matrix;  ///< −R⁻¹ Vᵀ
  Vector multiplier_offset;  ///< −R⁻¹ s

  [[nodiscard]] FclibSolution solution(const ContactSolution& found) const;
};
/// Throws Error(invalid_input) if R is singular.
[[nodiscard]] FclibReduction reduce(const FclibProblem& problem);

/// Converts the eligible points of a problem, `dimension` rows each: FCLib has no others. A point that has only its
/// normal receives tangents of its own (W_TT = W_NN, uncoupled; q_T = 0, μ = 0, so r_T = 0 = u_T), which `description`
/// states; `points` keeps the numbers. A solution of the problem is included: as the solution if it is one, otherwise
/// as a guess, and math_info reports which.
/// Throws Error(invalid_input), which names the point, if friction has a bound, which FCLib's law does not include, or
/// a point has tangents of another dimension.
[[nodiscard]] FclibProblem make_fclib(const ContactProblem& problem, Index dimension,
                                      const ContactSolution* solution = nullptr);

/// Stores a solver's result in a problem: as its solution or, if it is none, as its only guess. math_info reports
/// whether it solves the problem.
void put_solution(FclibProblem& problem, FclibSolution found, const ContactSolution& how);

}  // namespace ricochet
