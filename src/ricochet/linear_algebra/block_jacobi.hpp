#pragma once

#include <vector>

#include "ricochet/linear_algebra/conjugate_gradients.hpp"

/// @file The inverses of diagonal blocks as a preconditioner.
namespace ricochet {

/// P = the d × d diagonal blocks of a matrix with d dofs per node, d² numbers per node (of all ranks, where there are
/// several). Of what was measured for one step of elastodynamics (docs/performance.md) this is as fast as incomplete
/// Cholesky factors and polynomials in A on one thread and faster on more: inertia bounds the condition of A, so that
/// an iteration must be cheap before it is clever. `solved` per dof: the others are left alone (z = r there).
[[nodiscard]] std::unique_ptr<Preconditioner> make_block_jacobi(const Vector& blocks, int d,
                                                                const std::vector<char>& solved);

}  // namespace ricochet
