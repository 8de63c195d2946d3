#pragma once

#include <memory>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file The mass of single cells, for what needs more than their sum.
namespace ricochet {

/// ∫ wρ φ_i φ_j over one cell at a time, with w per material (empty: 1), as assemble_scalar_mass adds them. A cell with
/// tied nodes has those that they follow in their place, and TᵀmT. Keeps a
/// reference to the body. Not for two threads at once.
class CellMasses {
 public:
  explicit CellMasses(const Body& body, std::vector<double> weight = {});
  ~CellMasses();
  CellMasses(const CellMasses&) = delete;
  CellMasses& operator=(const CellMasses&) = delete;

  /// Calls visit(nodes of the cell, its matrix) for all cells, in the order of their numbers.
  using Visit = std::function<void(const std::vector<Index>& nodes, const Matrix& mass)>;
  void for_each(const Visit& visit) const;
  /// The same with ∫ρ φ_i φ_j and w.
  using VisitInertia = std::function<void(const std::vector<Index>& nodes, const Matrix& inertia, double weight)>;
  void for_each_inertia(const VisitInertia& visit) const;
  /// The nodes alone.
  void for_each_cell(const std::function<void(const std::vector<Index>& nodes)>& visit) const;
  /// Nodes that two cells have in common when they share a facet, at least.
  [[nodiscard]] int least_facet_nodes() const;

 private:
  [[nodiscard]] bool has_tied(const std::vector<Index>& nodes) const;
  [[nodiscard]] std::vector<Index> nodes_followed(const std::vector<Index>& nodes) const;
  [[nodiscard]] Matrix spreading_of(const std::vector<Index>& nodes, const std::vector<Index>& followed) const;

  const Body& body_;
  std::vector<double> weight_;
  struct Rules;
  std::unique_ptr<Rules> rules_;
};

}  // namespace ricochet
