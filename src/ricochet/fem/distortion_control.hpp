#pragma once

#include <memory>
#include <vector>

#include "ricochet/fem/elastic_cells.hpp"

/// @file Control of distortion of cells. Material laws are evaluated at quadrature points inside the cells, so that a
/// cell that is not a straight simplex of degree 1 can be turned inside out at a node with hardly any energy, in
/// particular in nearly incompressible bodies, whose dilatational energy is evaluated at a mean of J. The control adds
/// an energy, distortion_law.hpp, at points close to the nodes. It is zero while all their volume ratios are above
/// `distortion_volume_ratio`, and grows without bounds as one of them vanishes.
namespace ricochet {

class DistortionControl {
 public:
  /// Keeps a reference to the graph and the pointers of the body. `cells` as in ElasticCells.
  DistortionControl(const Body& body, const NodeGraph& graph, const std::vector<int>& cells);
  /// Whether the body has finite strain, and cells whose nodes are outside the hull of their quadrature points.
  [[nodiscard]] static bool applies_to(const Body& body);

  [[nodiscard]] CellVolume smallest_volume(const Vector& displacement) const {
    return cells_->smallest_volume(displacement);
  }
  // As those of ElasticCells, added to the result.
  [[nodiscard]] CellVolume add_force(const Vector& displacement, Vector& result) const;
  [[nodiscard]] CellVolume add_path_force(const Vector& middle, const Vector& increment, Vector& result) const;
  void add_path_tangent(const Vector& middle, const Vector& increment, const PathVariation& variation,
                        SparseMatrix& result) const;
  void add_tangent(const Vector& displacement, SparseMatrix& result) const;
  [[nodiscard]] double energy(const Vector& displacement) const { return cells_->energy(displacement); }

 private:
  Body body_;
  std::unique_ptr<ElasticCells> cells_;
  PathRules rules_;
  mutable Vector force_;
};

}  // namespace ricochet
