#pragma once

#include <vector>

#include "ricochet/linear_algebra/conjugate_gradients.hpp"

/// @file Block Jacobi preconditioner.
namespace ricochet {

/// P = the d × d diagonal blocks of a matrix with d dofs per node, d² numbers per node (sums over all ranks, if there
/// are several). For one step of elastodynamics (measured in docs/performance.md) it is as fast on one thread as
/// incomplete Cholesky factors and polynomials in A, and faster on more: inertia bounds the condition number of A, so
/// that cheap iterations pay more than fewer ones. `solved` per dof: other dofs are left unchanged (z = r there).
[[nodiscard]] std::unique_ptr<Preconditioner> make_block_jacobi(const Vector& blocks, int d,
                                                                const std::vector<char>& solved);

}  // namespace ricochet
