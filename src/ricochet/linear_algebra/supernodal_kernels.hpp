#pragma once

#include "ricochet/base/types.hpp"

/// @file The arithmetic of triangular solves with one supernode, limited by the speed at which the factor is read.
///
/// Supernodes are stored as in linear_algebra/supernode_layout.hpp: a forward solve reads one ascending stream of
/// numbers and a back solve the same stream descending. Sums are taken in an order that depends on the shape and on
/// reading_places() alone; a product and a sum are rounded once where the instruction set has that.
namespace ricochet {

/// The places in which a tall block is read at once. Intel's processors get a third more from memory in four places,
/// each of which the loops ask them to fetch ahead. AMD's follow one stream of cache lines, up or down, at the speed of
/// memory, and take twice the time with either. Forward solves have the same bits both ways, back solves sum in
/// another order.
enum class ReadingPlaces { one, four };
/// By the processor; four where the user has named an instruction set, whose bits are to be those of any processor.
[[nodiscard]] ReadingPlaces reading_places();

/// With w = (w₁, w₂), k and m−k numbers followed by one that is scratch:
/// w₁ ← L₁₁⁻¹ w₁, w₂ ← w₂ − L₂₁ w₁. Returns the end of the supernode in the stream.
const double* supernode_forward(const double* stream, Index columns, Index rows, double* w,
                                ReadingPlaces places = reading_places());
/// w₁ ← L₁₁⁻ᵀ (w₁ − L₂₁ᵀ w₂); w₂ is followed by a zero. Takes the end of the supernode and returns its beginning.
const double* supernode_backward(const double* stream_end, Index columns, Index rows, double* w,
                                 ReadingPlaces places = reading_places());
/// supernode_forward on eight right-hand sides at once; w is 8 × (m + 1), column by column. The bits of each are those
/// of its own solve if the others were not there.
const double* supernode_forward_eight(const double* stream, Index columns, Index rows, double* w);

// Parts of these, for supernodes that several threads share: a block of up to eight columns, or its panels.

/// w₁ ← L₁₁⁻¹ w₁, w₂ ← w₂ − L₂₁ w₁ of a block, whose rows below go no further than `rows_below`.
void supernode_forward_rows(Index columns, Index rows_below, const double* stream, double* w);
/// w ← w − L x, and per column eight sums of L w, of `count` panels that follow one another.
void panels_forward(Index columns, Index count, const double* stream, const double* x, double* w,
                    ReadingPlaces places = reading_places());
void panels_backward(Index columns, Index count, const double* stream, const double* w, double* sums,
                     ReadingPlaces places = reading_places());
/// The same of the rows that are fewer than eight.
void remainder_forward(Index columns, Index rows, const double* stream, const double* x, double* w);
void remainder_backward(Index columns, Index rows, const double* stream, const double* w, double* sums);
/// w ← L₁₁⁻ᵀ (w − Σ sums).
void triangle_backward(Index columns, const double* triangle, const double* sums, double* w);

}  // namespace ricochet
