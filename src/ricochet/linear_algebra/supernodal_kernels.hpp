#pragma once

#include "ricochet/base/types.hpp"

/// @file Arithmetic of triangular solves with one supernode, limited by the speed at which the factor is read.
///
/// Supernodes are stored as in linear_algebra/supernode_layout.hpp: a forward solve reads one ascending stream of
/// numbers and a backward solve the same stream descending. The order of sums depends on the shape and on
/// stream_count() alone; a product and a sum are rounded once if the instruction set has fused operations.
namespace ricochet {

/// Number of positions at which a tall block is read concurrently. Intel's processors get a third more memory bandwidth
/// from four positions, at each of which the loops prefetch. AMD's follow one stream of cache lines, up or down, at the
/// speed of memory, and take twice the time with either. Forward solves have the same bits both ways; backward solves
/// sum in another order.
enum class StreamCount { one, four };
/// Chosen by the processor; four if the user has named an instruction set, whose bits must be those of any processor.
[[nodiscard]] StreamCount stream_count();

/// Computes, for w = (w₁, w₂) with k and m−k numbers followed by one scratch number, w₁ ← L₁₁⁻¹ w₁, w₂ ← w₂ − L₂₁ w₁.
/// Returns the end of the supernode in the stream.
const double* supernode_forward(const double* stream, Index columns, Index rows, double* w,
                                StreamCount parallel_streams = stream_count());
/// Computes w₁ ← L₁₁⁻ᵀ (w₁ − L₂₁ᵀ w₂); w₂ is followed by a zero. Returns the beginning of the supernode, given its end.
const double* supernode_backward(const double* stream_end, Index columns, Index rows, double* w,
                                 StreamCount parallel_streams = stream_count());
/// Applies supernode_forward to eight right-hand sides at once; w is 8 × (m + 1), in column-major order. Each has the
/// bits of its own separate solve.
const double* supernode_forward_eight(const double* stream, Index columns, Index rows, double* w);

// Parts of these, for supernodes that several threads share: a block of up to eight columns, or its panels.

/// Computes w₁ ← L₁₁⁻¹ w₁, w₂ ← w₂ − L₂₁ w₁ for a block, restricted to the first `rows_below` rows below.
void supernode_forward_rows(Index columns, Index rows_below, const double* stream, double* w);
/// Compute w ← w − L x, and per column eight sums of Lᵀ w, for `count` consecutive panels.
void panels_forward(Index columns, Index count, const double* stream, const double* x, double* w,
                    StreamCount parallel_streams = stream_count());
void panels_backward(Index columns, Index count, const double* stream, const double* w, double* sums,
                     StreamCount parallel_streams = stream_count());
/// Versions for the remaining rows, fewer than eight.
void remainder_forward(Index columns, Index rows, const double* stream, const double* x, double* w);
void remainder_backward(Index columns, Index rows, const double* stream, const double* w, double* sums);
/// Computes w ← L₁₁⁻ᵀ (w − Σ sums).
void triangle_backward(Index columns, const double* triangle, const double* sums, double* w);

}  // namespace ricochet
