#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>

/// @file The number, vector and matrix types used everywhere.
namespace ricochet {

/// Counts and indices of nodes, cells and degrees of freedom. Signed, so that differences are safe.
using Index = Eigen::Index;

/// Dense column vector of dofs, multipliers, …
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Matrix in compressed sparse columns. All operators of the problem are symmetric and stored whole, so columns are
/// rows.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
/// Operators that act row by row (traces on the contact boundary).
using SparseRowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Coordinates of points, one per column: dimension × count.
using Points = Eigen::MatrixXd;

}  // namespace ricochet
