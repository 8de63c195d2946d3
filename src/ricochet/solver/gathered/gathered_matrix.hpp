#pragma once

#include <vector>

#include "ricochet/solver/gathered/gathered_nodes.hpp"

/// @file A matrix of which each rank has a part, gathered on one of them.
namespace ricochet {

/// Parts of a symmetric matrix on the dofs of these nodes (ascending; on all ranks those of `gathered`), added up at
/// home on all dofs there; elsewhere empty.
[[nodiscard]] SparseMatrix gather_matrix(const Ranks& ranks, const SparseMatrix& on_nodes,
                                         const std::vector<Index>& nodes, int d, const GatheredNodes& gathered);

}  // namespace ricochet
