#pragma once

#include "ricochet/linear_algebra/supernode_layout.hpp"

/// @file Arithmetic of the factorization: products and triangular solves of panels of eight rows
/// (linear_algebra/supernode_layout.hpp). Sums follow the order of the columns, whatever the shape around them.
namespace ricochet {

/// Eight rows of L, over a range of a supernode's columns.
struct PanelRows {
  const double* head = nullptr;    ///< 8 × head columns
  const double* blocks = nullptr;  ///< 8 × 8 of the first block
  Index stride = 64;               ///< from there to the next block's
  Index shrink = 0;                ///< decrease of the stride from block to block
};
/// A range of columns: those of the head (0: not in the range), then so many blocks.
struct PanelColumns {
  Index head = 0;
  Index blocks = 0;
};

/// Largest number of panels that are multiplied together as a group.
constexpr Index panels_per_group = 3;
/// Computes C = A Bᵀ for `count` panels A, consecutive in memory, and one panel B: 8 × 8 per panel, in column-major
/// order.
void multiply_panels(Index count, const PanelRows& a, const PanelRows& b, PanelColumns columns, double* c);

/// Target of a product of two panels in a matrix: rows or columns [begin, end) of the eight, and their indices.
struct PanelTarget {
  Index begin = 0, end = 8;
  const int* indices = nullptr;  ///< eight, ascending; those outside of [begin, end) are not read
};
/// Subtracts C, 8 × 8 in column-major order, from a matrix in column-major order.
void subtract_panel(const double* c, const PanelTarget& rows, const PanelTarget& columns, double* matrix, Index stride);
/// Computes C ← A − C for 8 rows and `columns` columns of A, in column-major order.
void subtract_from(const double* a, Index stride, Index columns, double* c);

/// Computes X = C L⁻ᵀ for C of 8 × `size`, with L⁻¹ as the layout stores it.
void solve_panel(Index size, const double* c, const double* inverse, double* x);

/// Factorizes a symmetric matrix, given by its lower triangle of `size` ≤ 8 (8 numbers per column), and writes L⁻¹ as
/// the layout stores it. Returns the first column whose pivot is not positive, or −1.
int invert_factor(Index size, const double* triangle, double* inverse);

}  // namespace ricochet
