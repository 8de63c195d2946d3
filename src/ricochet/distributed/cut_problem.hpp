#pragma once

#include "ricochet/distributed/division.hpp"
#include "ricochet/distributed/piece.hpp"

/// @file The part of a semi-discrete problem that one rank has.
namespace ricochet {

/// All of it but what cells make, the internal force, the damping and the loads: a mass, supports, contact. Entries of
/// the mass go to one rank each. Obstacles are those of the whole. Throws Error(invalid_input) where the contact cannot
/// be divided (contact_cut.hpp).
[[nodiscard]] SemidiscreteProblem cut_problem(const SemidiscreteProblem& whole, const Division& division,
                                              const Piece& piece, int rank);

/// Entries of a matrix with d dofs per node that belong to this rank, on the nodes of the piece.
[[nodiscard]] SparseMatrix cut_matrix(const NodeMatrix& whole, const Division& division, const Piece& piece, int rank);

/// Of a consistent vector, so many numbers per node, those of the piece.
[[nodiscard]] Vector cut_values(const Vector& whole, const Piece& piece, int per_node);

}  // namespace ricochet
