#include "ricochet/fem/cell_masses.hpp"

#include <algorithm>

#include "ricochet/fem/element_matrices.hpp"

namespace ricochet {

struct CellMasses::Rules {
  std::vector<MassIntegration> of_block;
};

CellMasses::CellMasses(const Body& body, std::vector<double> weight)
    : body_(body), weight_(std::move(weight)), rules_(std::make_unique<Rules>()) {
  for (const CellBlock& block : body.mesh->cells)
    rules_->of_block.emplace_back(block.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body));
}

CellMasses::~CellMasses() = default;

void CellMasses::for_each(const Visit& visit) const {
  for_each_inertia([&visit](const std::vector<Index>& nodes, const Matrix& inertia, double weight) {
    if (weight == 1.0) return visit(nodes, inertia);
    visit(nodes, weight * inertia);
  });
}

void CellMasses::for_each_inertia(const VisitInertia& visit) const {
  std::vector<Index> nodes;
  std::vector<double> pairs;
  Matrix mass;
  std::size_t number = 0;
  for (std::size_t b = 0; b < body_.space->cells.size(); ++b) {
    const CellBlock& cells = body_.space->cells[b];
    const int count = cells.nodes_per_cell;
    pairs.resize(std::size_t(pair_number(0, count)));
    mass.resize(count, count);
    for (Index cell = 0; cell < cells.size(); ++cell, ++number) {
      const auto material = std::size_t(body_.cell_material[number]);
      const double density = body_.materials[material].density;
      const Index* geometry = body_.mesh->cells[b].cell(cell);
      if (body_.mesh->dimension == 2) {
        element_mass<2>(rules_->of_block[b], body_.mesh->nodes, geometry, density, pairs.data());
      } else {
        element_mass<3>(rules_->of_block[b], body_.mesh->nodes, geometry, density, pairs.data());
      }
      for (int j = 0; j < count; ++j) {
        for (int i = 0; i <= j; ++i) mass(i, j) = mass(j, i) = pairs[std::size_t(pair_number(i, j))];
      }
      nodes.assign(cells.cell(cell), cells.cell(cell) + count);
      const double weight = weight_.empty() ? 1.0 : weight_[material];
      if (!has_tied(nodes)) {
        visit(nodes, mass, weight);
        continue;
      }
      const std::vector<Index> followed = untied_nodes_of(nodes);
      const Matrix spreading = tie_matrix(nodes, followed);
      const Matrix half = spreading.transpose() * mass * spreading;
      visit(followed, 0.5 * (half + half.transpose()), weight);
    }
  }
}

bool CellMasses::has_tied(const std::vector<Index>& nodes) const {
  return body_.tied != nullptr && std::ranges::any_of(nodes, [this](Index node) { return body_.tied->is_tied(node); });
}

/// Nodes that determine the values at the nodes of a cell.
std::vector<Index> CellMasses::untied_nodes_of(const std::vector<Index>& nodes) const {
  std::vector<Index> result;
  for (const Index node : nodes) {
    for (const auto& [other, weight] : body_.tied->spread({{node, 1.0}})) result.push_back(other);
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// T on a cell: its nodes × the nodes that determine them.
Matrix CellMasses::tie_matrix(const std::vector<Index>& nodes, const std::vector<Index>& followed) const {
  Matrix result = Matrix::Zero(Index(nodes.size()), Index(followed.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const auto& [other, weight] : body_.tied->spread({{nodes[i], 1.0}}))
      result(Index(i), std::ranges::lower_bound(followed, other) - followed.begin()) = weight;
  }
  return result;
}

void CellMasses::for_each_cell(const std::function<void(const std::vector<Index>& nodes)>& visit) const {
  for (const CellBlock& cells : body_.space->cells) {
    for (Index cell = 0; cell < cells.size(); ++cell) {
      const std::vector<Index> nodes(cells.cell(cell), cells.cell(cell) + cells.nodes_per_cell);
      visit(has_tied(nodes) ? untied_nodes_of(nodes) : nodes);
    }
  }
}

/// For a simplex: d with degree 1, d (d + 1) / 2 with degree 2.
int CellMasses::least_facet_nodes() const {
  const int d = body_.mesh->dimension;
  return body_.space->degree == 1 ? d : d * (d + 1) / 2;
}

}  // namespace ricochet
