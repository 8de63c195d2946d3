#pragma once

#include <array>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/linear_algebra/dense_factor.hpp"
#include "ricochet/solver/contact/contact_system.hpp"

/// @file Factor of an earlier Newton system as a preconditioner of the present one.
namespace ricochet {

/// Unknown x of a Newton step: r = … + x trial, and the equation test·u + diagonal x = 0, on the rows of one point. The
/// tests of a point are orthonormal, and test·trial = 1 for the same unknown, 0 for others.
struct ContactUnknown {
  Index problem_row = 0;  ///< row of the problem that corresponds to `row`
  Index row = 0, size = 0;
  std::array<double, 3> trial{}, test{};
  double diagonal = 0.0;
  /// Compares the data on which a factor depends, independent of the system.
  bool operator==(const ContactUnknown& other) const {
    return problem_row == other.problem_row && size == other.size && trial == other.trial && test == other.test &&
           diagonal == other.diagonal;
  }
  [[nodiscard]] auto members() { return std::tie(trial, test, diagonal); }
};

[[nodiscard]] inline double test_motion(const ContactUnknown& unknown, const double* motion) {
  const double* at = motion + unknown.row;
  double sum = unknown.test[0] * at[0];
  if (unknown.size > 1) sum += unknown.test[1] * at[1];
  if (unknown.size > 2) sum += unknown.test[2] * at[2];
  return sum;
}

/// Between two Newton systems a few points change their state and directions of slip turn slightly. The part of u on
/// points that both systems have is solved with the factor of the earlier one (single precision); the remainder (a new
/// point, a direction that now sticks) with the diagonal of W.
class ReusedFactor {
 public:
  void reset() { unknowns_.clear(); }
  [[nodiscard]] bool empty() const { return unknowns_.empty(); }
  /// Factorizes the matrix of the system for these unknowns. Returns false if it is singular.
  bool compute(const Matrix& matrix, const std::vector<ContactUnknown>& unknowns);
  /// Maps the rows of the earlier unknowns to this system, before `apply`. Returns false if the system does not have
  /// all of them, or (after `load`) their matrix is singular.
  bool map_rows(const ContactSystem& system, const std::vector<ContactUnknown>& unknowns);
  /// Computes z ≈ (system of the unknowns given to `map_rows`)⁻¹ b.
  void apply(const Vector& right, Vector& z) const;

  /// Saves and loads the unknowns: the factor is made again at the next `map_rows`, with the same bits. Throws
  /// Error(invalid_input) unless they are unknowns on points with these rows (ContactProblem::row_offset); those that
  /// are loaded are then incomplete.
  void persist(const SnapshotVisitor& visit, const std::vector<Index>& row_offset);
  /// True if one of the unknowns belongs to the point that begins with this row of the problem.
  [[nodiscard]] bool keeps_row(Index problem_row) const;

 private:
  std::vector<ContactUnknown> unknowns_;  ///< of the factor
  std::vector<ContactUnknown> present_;   ///< of the system to solve
  bool same_ = false;
  bool is_factored_ = false;
  std::vector<double> compliance_;  ///< per row of the system: 1/w
  SingleLu factor_;
  mutable Vector motion_, reaction_, earlier_right_, earlier_solution_;
};

/// Assembles the rows test·(W trial) + diagonal of the unknowns; W dense.
void assemble_contact_matrix(const ContactSystem& system, const std::vector<ContactUnknown>& unknowns, Vector& column,
                             Matrix& matrix);

}  // namespace ricochet
