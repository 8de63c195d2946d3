#pragma once

#include "ricochet/linear_algebra/supernode_layout.hpp"

/// @file The arithmetic of the factorization: products and triangular solves of panels of eight rows
/// (linear_algebra/supernode_layout.hpp). Sums are taken in the order of the columns, whatever the shape around them.
namespace ricochet {

/// Eight rows of L, over a range of a supernode's columns.
struct PanelRows {
  const double* head = nullptr;    ///< 8 × head columns
  const double* blocks = nullptr;  ///< 8 × 8 of the first block
  Index stride = 64;               ///< from there to the next block's
  Index shrink = 0;                ///< of the stride, from block to block
};
/// The range of columns: those of the head (0: not of the range), then so many blocks.
struct PanelColumns {
  Index head = 0;
  Index blocks = 0;
};

/// A group of panels that are multiplied together, at most.
constexpr Index panels_per_group = 3;
/// C = A Bᵀ of `count` panels A, which follow one another in memory, and one panel B: 8 × 8 per panel, column by
/// column.
void multiply_panels(Index count, const PanelRows& a, const PanelRows& b, PanelColumns columns, double* c);

/// Where a product of two panels belongs in a matrix: rows and columns [begin, end) of the eight, and their places.
struct PanelPlaces {
  Index begin = 0, end = 8;
  const int* places = nullptr;  ///< eight, ascending; those outside of [begin, end) are not read
};
/// Subtracts C, 8 × 8, column by column, from a matrix stored column by column.
void subtract_panel(const double* c, const PanelPlaces& rows, const PanelPlaces& columns, double* matrix, Index stride);
/// C ← A − C with 8 rows and so many columns of A, stored column by column.
void subtract_from(const double* a, Index stride, Index columns, double* c);

/// X = C L⁻ᵀ with C of 8 × `size`, and L⁻¹ as the layout has it.
void solve_panel(Index size, const double* c, const double* inverse, double* x);

/// L of a symmetric matrix's lower triangle of `size` ≤ 8 (8 numbers per column), and its inverse as the layout has it.
/// Returns the first column whose pivot is not positive, or −1.
int invert_factor(Index size, const double* triangle, double* inverse);

}  // namespace ricochet
