#pragma once

#include <vector>

#include "ricochet/solver/gathered/gathered_nodes.hpp"

/// @file A matrix whose parts are on the ranks, gathered on one of them.
namespace ricochet {

/// Sums parts of a symmetric matrix on the dofs of these nodes (ascending; on all ranks those of `gathered`) at the
/// root, on all dofs there; elsewhere empty.
[[nodiscard]] SparseMatrix gather_matrix(const Ranks& ranks, const SparseMatrix& on_nodes,
                                         const std::vector<Index>& nodes, int d, const GatheredNodes& gathered);

}  // namespace ricochet
