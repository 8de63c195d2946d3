#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file From values of cells to values at nodes.
namespace ricochet {

/// Values at the nodes of linear functions that fit the values of the cells around them, taken at their centres, in the
/// sense of least squares (the superconvergent patch recovery of O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer. Meth.
/// Engng. 33 (1992) 1331–1364, with one sample per cell). Exact where the values are those of a linear function. Where
/// the cells around a node do not determine a linear function, or only by extrapolating far (Σ |weights| > 2.5, at
/// corners), those around them are taken in.
struct NodalRecovery {
  SparseRowMatrix weights;      ///< rows × cells
  std::vector<Index> row_node;  ///< of each row; a node has one for each material around it, ascending
};
[[nodiscard]] NodalRecovery make_nodal_recovery(const Body& body);

/// Stress at the nodes that is consistent with the means over the cells. Two things hold that the fits alone do not
/// give:
///   - Where materials meet, stress jumps, and its mean is that of neither: the node has the fit of the material with
///     the largest von Mises stress.
///   - Von Mises' stress is a convex function of the stress, so that its largest value in a cell is at least that of
///     the cell's mean. At a concentration the fit, a mean over several cells, may stay below it at all nodes of the
///     peak's cell; the node of that cell at which the fit is largest then has the stress of the cell (the largest of
///     those of several cells).
/// The largest von Mises stress at the nodes of a cell is therefore never less than that of the cell's mean. A single
/// node may have less than the cells around it: that of a bent beam's neutral axis has none.
class NodalStress {
 public:
  /// Keeps a reference.
  explicit NodalStress(const Body& body);
  /// `cells`: six components per cell (stress.hpp); `nodes`: likewise per node, in the numbering for people.
  void evaluate(const std::vector<double>& cells, std::vector<double>& nodes);

 private:
  void fit(const std::vector<double>& cells, std::vector<double>& nodes);
  void claim(const std::vector<double>& cells);

  const Body& body_;
  NodalRecovery recovery_;
  std::vector<double> von_mises_;      ///< per node of the space
  std::vector<Index> claim_;           ///< per node, the cell whose stress it takes, or −1
  std::vector<double> claimed_value_;  ///< von Mises stress of that
};

}  // namespace ricochet
