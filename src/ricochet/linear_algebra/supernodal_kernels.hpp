#pragma once

#include "ricochet/base/types.hpp"

/// @file The arithmetic of triangular solves with one supernode, limited by the speed at which the factor is read.
///
/// A supernode has k columns and m ≥ k rows, the first k of which are its own. Its columns are cut into blocks of up to
/// eight. A block with c columns, whose rows below its triangle are n, is stored as
///   - the inverse of its c × c triangle, column by column, each column filled with zeros to 2, 4 or 8 numbers;
///   - the n rows below in panels of eight rows, the last ones of four and two (an odd row filled with zeros); a panel
///   is stored
///     column by column.
/// So a forward solve reads one ascending stream of numbers and a back solve the same stream descending: the processor
/// fetches ahead by itself, and the loops ask it to besides. Sums are taken in an order that depends on the shape
/// alone, without fused operations: the bits do not depend on the instruction set.
namespace ricochet {

/// Numbers that a supernode takes in the stream.
[[nodiscard]] Index supernode_stream_size(Index columns, Index rows);
/// Writes one: `factor` is m × k, column by column (what is above the diagonal is not read). Returns the end.
double* write_supernode(const double* factor, Index columns, Index rows, double* stream);

/// With w = (w₁, w₂), k and m−k numbers followed by one that is scratch:
/// w₁ ← L₁₁⁻¹ w₁, w₂ ← w₂ − L₂₁ w₁. Returns the end of the supernode in the stream.
const double* supernode_forward(const double* stream, Index columns, Index rows, double* w);
/// w₁ ← L₁₁⁻ᵀ (w₁ − L₂₁ᵀ w₂); w₂ is followed by a zero. Takes the end of the supernode and returns its beginning.
const double* supernode_backward(const double* stream_end, Index columns, Index rows, double* w);
/// supernode_forward on eight right-hand sides at once; w is 8 × (m + 1), column by column. The bits of each are those
/// of its own solve if the others were not there.
const double* supernode_forward_eight(const double* stream, Index columns, Index rows, double* w);

}  // namespace ricochet
