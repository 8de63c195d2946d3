#include "ricochet/fem/nodal_recovery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/stress.hpp"

namespace ricochet {

namespace {

/// Locations at which linear functions have their means over the cells of axisymmetric bodies: the centres of gravity
/// of the cells as rings, with the rule of the stress.
Points centres_of_rings(const Body& body) {
  Points result(2, body.mesh->cell_count());
  Index number = 0;
  for (const CellBlock& block : body.mesh->cells) {
    const BlockIntegration rule = stiffness_integration(block.shape, body.mesh->degree, body.space->degree, true);
    for (Index cell = 0; cell < block.size(); ++cell, ++number) {
      const Index* const nodes = block.cell(cell);
      double volume = 0.0;
      result.col(number).setZero();
      for (Index q = 0; q < rule.rule.weights.size(); ++q) {
        const Matrix& gradients = rule.geometry.gradients[std::size_t(q)];
        const double weight = rule.rule.weights[q] * jacobian<2>(body.mesh->nodes, nodes, gradients).determinant() *
                              rule.ring(body.mesh->nodes, nodes, q);
        for (int k = 0; k < block.nodes_per_cell; ++k)
          result.col(number) += weight * rule.geometry.values(k, q) * body.mesh->nodes.col(nodes[k]);
        volume += weight;
      }
      result.col(number) /= volume;
    }
  }
  return result;
}

/// Largest patch: the cells at a node, extended by their neighbours up to widest_patch − 1 times.
constexpr int widest_patch = 3;
/// Relative tolerance for the rank of the fit's columns.
constexpr double dependence = 1e-3;
/// Largest Σ |weights| of an acceptable fit, which bounds how far the value at the node may exceed those of the cells.
/// A few cells on one side of a node determine a linear function, but extrapolate any other variation too far.
constexpr double most_amplification = 2.5;

class Recovery {
 public:
  explicit Recovery(const Body& body) : body_(body), dimension_(body.mesh->dimension) {
    const Index nodes = body.space->node_count();
    std::vector<Index> count(static_cast<std::size_t>(nodes) + 1, 0);
    centres_.resize(dimension_, body.mesh->cell_count());
    for (const CellBlock& block : body.space->cells) {
      for (Index cell = 0; cell < block.size(); ++cell) {
        cell_nodes_.emplace_back(block.cell(cell), block.nodes_per_cell);
        const auto number = Index(cell_nodes_.size()) - 1;
        Vector centre = Vector::Zero(dimension_);
        for (int i = 0; i < block.nodes_per_cell; ++i) {
          centre += body.space->nodes.col(block.cell(cell)[i]);
          ++count[std::size_t(block.cell(cell)[i]) + 1];
        }
        centres_.col(number) = centre / block.nodes_per_cell;
      }
    }
    if (is_axisymmetric(body)) centres_ = centres_of_rings(body);
    for (std::size_t i = 1; i < count.size(); ++i) count[i] += count[i - 1];
    first_ = count;
    cells_.resize(std::size_t(first_.back()));
    for (std::size_t cell = 0; cell < cell_nodes_.size(); ++cell) {
      for (int i = 0; i < cell_nodes_[cell].second; ++i)
        cells_[std::size_t(count[std::size_t(cell_nodes_[cell].first[i])]++)] = Index(cell);
    }
  }

  /// Returns cells and their weights for a node, for each adjacent material.
  std::vector<std::vector<std::pair<Index, double>>> weights(Index node) const {
    std::vector<int> materials;
    visit_cells(node, [&](Index cell) { materials.push_back(material(cell)); });
    std::ranges::sort(materials);
    materials.erase(std::unique(materials.begin(), materials.end()), materials.end());
    std::vector<std::vector<std::pair<Index, double>>> result;
    for (const int each : materials) result.push_back(fit(node, each));
    return result;
  }

 private:
  template <class Visit>
  void visit_cells(Index node, const Visit& visit) const {
    for (Index i = first_[std::size_t(node)]; i < first_[std::size_t(node) + 1]; ++i) visit(cells_[std::size_t(i)]);
  }
  [[nodiscard]] int material(Index cell) const { return body_.cell_material[std::size_t(cell)]; }

  void widen(int of_material, std::vector<Index>& patch) const {
    const std::vector<Index> before = patch;
    for (const Index cell : before) {
      const auto& [nodes, count] = cell_nodes_[std::size_t(cell)];
      for (int i = 0; i < count; ++i) {
        visit_cells(nodes[i], [&](Index other) {
          if (material(other) == of_material) patch.push_back(other);
        });
      }
    }
    std::ranges::sort(patch);
    patch.erase(std::unique(patch.begin(), patch.end()), patch.end());
  }

  using Weights = std::vector<std::pair<Index, double>>;

  /// The value at the node of the fit Σ_c (a + b·(x_c − x) − v_c)² → min is the sum of the cells' values v_c with these
  /// weights.
  Weights fit(Index node, int of_material) const {
    std::vector<Index> patch;
    visit_cells(node, [&](Index cell) {
      if (material(cell) == of_material) patch.push_back(cell);
    });
    const std::vector<Index> nearest = patch;
    Weights best;
    double least = std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < widest_patch && least > most_amplification; ++attempt) {
      if (attempt > 0) widen(of_material, patch);
      Weights found = fit(node, patch);
      if (found.empty()) continue;
      double amplification = 0.0;
      for (const auto& [cell, weight] : found) amplification += std::abs(weight);
      if (amplification >= least) continue;
      least = amplification;
      best = std::move(found);
    }
    if (!best.empty()) return best;
    for (const Index cell : nearest) best.emplace_back(cell, 1.0 / double(nearest.size()));
    return best;
  }

  /// Returns no weights if the cells of the patch do not determine a linear function.
  Weights fit(Index node, const std::vector<Index>& patch) const {
    const auto count = Index(patch.size());
    if (count <= dimension_) return {};
    Matrix columns(count, dimension_ + 1);
    columns.col(0).setOnes();
    for (Index i = 0; i < count; ++i) {
      columns.row(i).tail(dimension_) =
          (centres_.col(patch[std::size_t(i)]) - body_.space->nodes.col(node)).transpose();
    }
    columns.rightCols(dimension_) /= columns.rightCols(dimension_).norm();
    const PivotedQr factor(columns, dependence);
    if (factor.rank() <= dimension_) return {};
    // a = e₀ᵀ (columns)⁺ values: the first row of the pseudo-inverse.
    const Matrix inverse = factor.solve(Matrix(Matrix::Identity(count, count)));
    Weights result;
    for (Index i = 0; i < count; ++i) result.emplace_back(patch[std::size_t(i)], inverse(0, i));
    return result;
  }

  const Body& body_;
  int dimension_;
  Points centres_;
  std::vector<std::pair<const Index*, int>> cell_nodes_;
  std::vector<Index> first_, cells_;  ///< cells of each node
};

}  // namespace

NodalRecovery make_nodal_recovery(const Body& body) {
  const Recovery recovery(body);
  const Index nodes = body.space->node_count();
  std::vector<std::vector<std::vector<std::pair<Index, double>>>> weights(static_cast<std::size_t>(nodes));
  parallel_ranges(nodes, [&](Index first, Index last) {
    for (Index node = first; node < last; ++node) weights[std::size_t(node)] = recovery.weights(node);
  });
  NodalRecovery result;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index node = 0; node < nodes; ++node) {
    for (const auto& of_material : weights[std::size_t(node)]) {
      const auto row = int(result.row_node.size());
      for (const auto& [cell, weight] : of_material) entries.emplace_back(row, int(cell), weight);
      result.row_node.push_back(node);
    }
  }
  result.weights.resize(Index(result.row_node.size()), body.mesh->cell_count());
  result.weights.setFromTriplets(entries.begin(), entries.end());
  return result;
}

NodalStress::NodalStress(const Body& body) : body_(body), recovery_(make_nodal_recovery(body)) {}

void NodalStress::fit(const std::vector<double>& cells, std::vector<double>& nodes) {
  using Tensor = Eigen::Matrix<double, tensor_components, 1>;
  const auto count = std::size_t(body_.space->node_count());
  nodes.assign(tensor_components * count, 0.0);
  von_mises_.assign(count, -1.0);
  for (Index row = 0; row < recovery_.weights.rows(); ++row) {
    Tensor sum = Tensor::Zero();
    for (SparseRowMatrix::InnerIterator entry(recovery_.weights, row); entry; ++entry)
      sum += entry.value() * Eigen::Map<const Tensor>(cells.data() + tensor_components * entry.col());
    const auto node = std::size_t(recovery_.row_node[std::size_t(row)]);
    const double value = von_mises_stress(sum.data());
    if (!(value > von_mises_[node])) continue;
    von_mises_[node] = value;
    Eigen::Map<Tensor>(nodes.data() + tensor_components * body_.space->number[node]) = sum;
  }
}

/// Finds the cells whose value exceeds the fit; each claims its node with the largest fit.
void NodalStress::claim(const std::vector<double>& cells) {
  claim_.assign(von_mises_.size(), -1);
  claimed_value_.assign(von_mises_.size(), 0.0);
  each_cell(body_.space->cells, [&](Index cell, std::span<const Index> nodes) {
    const double own = von_mises_stress(cells.data() + tensor_components * cell);
    Index largest = nodes.front();
    for (const Index node : nodes) {
      const double value = von_mises_[std::size_t(node)];
      const double best = von_mises_[std::size_t(largest)];
      if (value >= own) return;
      const auto number = [&](Index each) { return body_.space->number[std::size_t(each)]; };
      if (value > best || (value == best && number(node) < number(largest))) largest = node;
    }
    const auto at = std::size_t(largest);
    if (claim_[at] >= 0 && !(own > claimed_value_[at])) return;
    claim_[at] = cell;
    claimed_value_[at] = own;
  });
}

void NodalStress::evaluate(const std::vector<double>& cells, std::vector<double>& nodes) {
  fit(cells, nodes);
  claim(cells);
  for (std::size_t node = 0; node < claim_.size(); ++node) {
    if (claim_[node] < 0) continue;
    std::copy_n(cells.begin() + tensor_components * claim_[node], tensor_components,
                nodes.begin() + tensor_components * body_.space->number[node]);
  }
}

}  // namespace ricochet
