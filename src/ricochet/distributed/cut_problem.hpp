#pragma once

#include "ricochet/distributed/division.hpp"
#include "ricochet/distributed/piece.hpp"

/// @file The part of a semidiscrete problem that one rank has.
namespace ricochet {

/// Returns the part without the contributions of cells (internal force, damping and loads): mass, supports, contact.
/// Each entry of the mass belongs to one rank. Obstacles are those of the whole. Throws Error(invalid_input) if the
/// contact cannot be divided (contact_cut.hpp).
[[nodiscard]] SemidiscreteProblem cut_problem(const SemidiscreteProblem& global, const Division& division,
                                              const Piece& piece, int rank);

/// Returns the entries of a matrix with d dofs per node that belong to this rank, on the nodes of the piece.
[[nodiscard]] SparseMatrix cut_matrix(const NodeMatrix& global, const Division& division, const Piece& piece, int rank);

/// Returns the entries of a consistent vector, with so many numbers per node, at the nodes of the piece.
[[nodiscard]] Vector cut_values(const Vector& global, const Piece& piece, int per_node);

}  // namespace ricochet
