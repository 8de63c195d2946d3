#pragma once

#include "ricochet/fem/assembly.hpp"

/// @file From values of cells to values at nodes.
namespace ricochet {

/// Nodes × cells: the value at a node of the linear function that fits the values of the cells around it, taken at
/// their centres, in the sense of least squares (the superconvergent patch recovery of O. C. Zienkiewicz and J. Z. Zhu,
/// Int. J. Numer. Meth. Engng. 33 (1992) 1331–1364, with one sample per cell). Exact where the values are those of a
/// linear function. Where materials meet, the mean of the fits of each; where the cells around a node do not determine
/// a linear function, or only by extrapolating far (Σ |weights| > 2.5, at corners), those around them are taken in.
[[nodiscard]] SparseRowMatrix make_nodal_recovery(const Body& body);

}  // namespace ricochet
