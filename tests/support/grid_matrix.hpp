#pragma once

#include <random>

#include "ricochet/base/types.hpp"

/// @file Matrices with the structure of those of bodies, without a body.
namespace ricochet::test_support {

/// Returns a number between −1 and 1, the same on every system.
[[nodiscard]] double uniform(std::mt19937& random);
/// Returns a vector of such numbers.
[[nodiscard]] Vector random_vector(Index size, unsigned seed);
/// Returns a positive definite matrix: blocks of `components` unknowns per node of a grid of `dimension` dimensions
/// with `side` nodes in each, coupled with all neighbours, also across corners.
[[nodiscard]] SparseMatrix grid_matrix(int dimension, int side, int components, unsigned seed);

}  // namespace ricochet::test_support
