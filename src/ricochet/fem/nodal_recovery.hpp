#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Recovery of nodal values from cell values.
namespace ricochet {

/// Values at the nodes of the linear functions that fit the values of the surrounding cells, located at their centres,
/// in the least-squares sense (the superconvergent patch recovery of O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer.
/// Meth. Engng. 33 (1992) 1331–1364, with one sample per cell). Exact if the values are those of a linear function. If
/// the cells around a node do not determine a linear function, or only by far extrapolation (Σ |weights| > 2.5, at
/// corners), the patch is extended by the cells around them.
struct NodalRecovery {
  SparseRowMatrix weights;      ///< rows × cells
  std::vector<Index> row_node;  ///< per row; a node has one row per adjacent material; ascending
};
[[nodiscard]] NodalRecovery make_nodal_recovery(const Body& body);

/// Stress at the nodes that is consistent with the means over the cells. Two properties go beyond the fits alone:
///   - At material interfaces stress is discontinuous, and the mean is the stress of neither side: the node has the fit
///     of the material with the largest von Mises stress.
///   - Von Mises stress is a convex function of the stress, so that its largest value in a cell is at least that of the
///     cell's mean. At a stress concentration the fit, a mean over several cells, may
/// remain below it at all nodes of the
///     peak's cell; the node of that cell with the largest fit is then assigned the stress of the cell (the largest if
///     several cells compete).
/// The largest von Mises stress at the nodes of a cell is therefore never less than that of the cell's mean. A single
/// node may have less than the cells around it: a node on the neutral axis of a bent beam has none.
class NodalStress {
 public:
  /// Keeps a reference.
  explicit NodalStress(const Body& body);
  /// `cells`: six components per cell (stress.hpp); `nodes`: likewise per node, in the order
  /// of DisplacementSpace::number.
  void evaluate(const std::vector<double>& cells, std::vector<double>& nodes);

 private:
  void fit(const std::vector<double>& cells, std::vector<double>& nodes);
  void claim(const std::vector<double>& cells);

  const Body& body_;
  NodalRecovery recovery_;
  std::vector<double> von_mises_;      ///< per node of the space
  std::vector<Index> claim_;           ///< per node: the cell whose stress is assigned to it, or −1
  std::vector<double> claimed_value_;  ///< von Mises stress of that cell
};

}  // namespace ricochet
