#pragma once

#include "support/uniform.hpp"

/// @file Matrices with the structure of those of bodies, without a body.
namespace ricochet::test_support {

/// Returns a vector of numbers between −1 and 1.
[[nodiscard]] Vector random_vector(Index size, unsigned seed);
/// Returns a positive definite matrix: blocks of `components` unknowns per node of a grid of `dimension` dimensions
/// with `side` nodes in each, coupled with all neighbours, also across corners.
[[nodiscard]] SparseMatrix grid_matrix(int dimension, int side, int components, unsigned seed);

}  // namespace ricochet::test_support
