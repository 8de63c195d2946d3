#pragma once

#include <memory>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Mass matrices of single cells, for algorithms that need more than their sum.
namespace ricochet {

/// Computes ∫ wρ φ_i φ_j over one cell at a time, with w per material (empty: 1), as summed in
/// assemble_scalar_mass. Tied nodes of a cell are replaced by the nodes to which they are tied, with the matrix
/// TᵀmT. Keeps a reference to the body. Not thread-safe.
class CellMasses {
 public:
  explicit CellMasses(const Body& body, std::vector<double> weight = {});
  ~CellMasses();
  CellMasses(const CellMasses&) = delete;
  CellMasses& operator=(const CellMasses&) = delete;

  /// Calls visit(nodes of the cell, its matrix) for all cells, in the order of their numbers.
  using Visit = std::function<void(const std::vector<Index>& nodes, const Matrix& mass)>;
  void for_each(const Visit& visit) const;
  /// Calls visit(nodes, ∫ρ φ_i φ_j, w) for all cells.
  using VisitInertia = std::function<void(const std::vector<Index>& nodes, const Matrix& inertia, double weight)>;
  void for_each_inertia(const VisitInertia& visit) const;
  /// Calls visit(nodes) for all cells.
  void for_each_cell(const std::function<void(const std::vector<Index>& nodes)>& visit) const;
  /// Least number of common nodes of two cells that share a facet.
  [[nodiscard]] int least_facet_nodes() const;

 private:
  [[nodiscard]] bool has_tied(const std::vector<Index>& nodes) const;
  [[nodiscard]] std::vector<Index> untied_nodes_of(const std::vector<Index>& nodes) const;
  [[nodiscard]] Matrix tie_matrix(const std::vector<Index>& nodes, const std::vector<Index>& followed) const;

  const Body& body_;
  std::vector<double> weight_;
  struct Rules;
  std::unique_ptr<Rules> rules_;
};

}  // namespace ricochet
