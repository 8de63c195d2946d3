#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/mass/cell_rings.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Σ|w| of a contact node up to which no further donors are sought. Weights that extrapolate have both signs; on
/// straight simplices of degree 2 with a facet on the contact boundary they are 2, −1 or 1, 1, −1.
constexpr double small_weights = 4.0;
/// Number of rings of cells after which `fair_weights` suffice.
constexpr std::size_t many_rings = 4;
constexpr double fair_weights = 10.0;

/// Extension of a cell: its contact nodes are extrapolated from massive nodes of its own, or of it and its neighbours.
struct CellExtension {
  std::vector<Index> donors;                                 ///< ascending
  Matrix rows;                                               ///< E_e, nodes of the cell × donors
  double weights = std::numeric_limits<double>::infinity();  ///< the largest Σ|w|
};

/// Builds one mass matrix.
class Builder {
 public:
  explicit Builder(const MassInput& input);
  SparseMatrix build();

 private:
  void add_cell(const std::vector<Index>& nodes, const Matrix& mass);
  void add_value(Index row, Index column, double value);
  CellExtension extend(const std::vector<Index>& nodes);
  [[nodiscard]] CellExtension extend_from(const std::vector<Index>& nodes, std::vector<Index> donors) const;
  void start_rings();
  void add_massive_nodes(int cell, std::vector<Index>& donors);
  void require_massive_nodes_of_body(const std::vector<Index>& nodes);
  [[nodiscard]] std::vector<Index> massive_nodes_of(const std::vector<Index>& nodes) const;
  void extrapolate(const std::vector<Index>& nodes, CellExtension& extension) const;
  [[nodiscard]] bool is_contact(Index node) const { return is_contact_[std::size_t(node)] != 0; }
  [[noreturn]] void refuse(const std::vector<Index>& nodes, const std::vector<Index>& body) const;

  const MassInput& input_;
  std::vector<char> is_contact_;
  Vector inertia_diagonal_;  ///< m_jj
  std::unique_ptr<CellRings> rings_;
  std::vector<char> is_checked_;                ///< per cell: whether the massive nodes of its body have been checked
  std::vector<int> visited_by_;                 ///< per node: the last cell that used it as a donor
  SparseMatrix result_;                         ///< on the pattern of M
  std::vector<Eigen::Triplet<double>> beyond_;  ///< entries outside that pattern
  int number_ = 0;                              ///< of the current cell, from 1
};

Builder::Builder(const MassInput& input)
    : input_(input), is_contact_(input.marked_contact_nodes()), inertia_diagonal_(input.inertia_matrix().diagonal()) {}

void Builder::add_value(Index row, Index column, double value) {
  if (double* const entry = stored_entry(result_, row, column); entry != nullptr) {
    *entry += value;
  } else {
    beyond_.emplace_back(int(row), int(column), value);
  }
}

SparseMatrix Builder::build() {
  result_ = zeros_without(input_.inertia_matrix(), is_contact_);
  input_.cells->for_each([this](const std::vector<Index>& nodes, const Matrix& mass) { add_cell(nodes, mass); });
  if (!beyond_.empty()) {
    SparseMatrix beyond(result_.rows(), result_.cols());
    beyond.setFromTriplets(beyond_.begin(), beyond_.end());
    add_sparse(result_, beyond).swap(result_);
  }
  return std::move(result_);
}

/// Adds E_eᵀ m_e E_e.
void Builder::add_cell(const std::vector<Index>& nodes, const Matrix& mass) {
  ++number_;
  const auto count = Index(nodes.size());
  if (std::ranges::none_of(nodes, [this](Index node) { return is_contact(node); })) {
    for (Index j = 0; j < count; ++j) {
      for (Index i = 0; i < count; ++i) add_value(nodes[std::size_t(i)], nodes[std::size_t(j)], mass(i, j));
    }
    return;
  }
  const CellExtension extension = extend(nodes);
  const Matrix moved = extension.rows.transpose() * mass * extension.rows;
  const auto donors = Index(extension.donors.size());
  for (Index j = 0; j < donors; ++j) {
    for (Index i = 0; i < donors; ++i) {
      add_value(extension.donors[std::size_t(i)], extension.donors[std::size_t(j)], 0.5 * (moved(i, j) + moved(j, i)));
    }
  }
}

/// Extrapolates from the cell's own massive nodes if they suffice, else from more and more rings of cells.
CellExtension Builder::extend(const std::vector<Index>& nodes) {
  std::vector<Index> donors = massive_nodes_of(nodes);
  CellExtension best = extend_from(nodes, donors);
  if (best.weights <= small_weights) return best;
  if (!rings_) start_rings();
  require_massive_nodes_of_body(nodes);
  rings_->start(number_ - 1);
  for (const Index donor : donors) visited_by_[std::size_t(donor)] = number_;
  for (std::size_t ring = 1, visited = 1, tried = donors.size(); rings_->grow(); ++ring) {
    for (; visited < rings_->cells().size(); ++visited) add_massive_nodes(rings_->cells()[visited], donors);
    // Far away, a few additional donors make no difference.
    if (donors.size() > (ring <= many_rings ? tried : tried + tried / 4)) {
      tried = donors.size();
      std::ranges::sort(donors);
      CellExtension extension = extend_from(nodes, donors);
      if (extension.weights < best.weights) std::swap(best, extension);
    }
    if (best.weights <= (ring < many_rings ? small_weights : fair_weights)) return best;
    if (rings_->cells().size() > CellRings::many_cells && std::isfinite(best.weights)) return best;
  }
  if (!std::isfinite(best.weights)) refuse(nodes, rings_->nodes());
  return best;  // extrapolated from all massive nodes of the body
}

void Builder::start_rings() {
  rings_ = std::make_unique<CellRings>(*input_.cells, input_.consistent->cols());
  is_checked_.assign(std::size_t(rings_->count()), 0);
  visited_by_.assign(is_contact_.size(), 0);
}

void Builder::add_massive_nodes(int cell, std::vector<Index>& donors) {
  for (int k = 0; k < rings_->node_count(cell); ++k) {
    const auto node = std::size_t(rings_->nodes(cell)[k]);
    if (is_contact_[node] != 0 || visited_by_[node] == number_) continue;
    visited_by_[node] = number_;
    donors.push_back(Index(node));
  }
}

/// Rejects, once per body, a body that no number of rings would remedy: the search would extend over it for every cell.
void Builder::require_massive_nodes_of_body(const std::vector<Index>& nodes) {
  if (is_checked_[std::size_t(number_ - 1)] != 0) return;
  rings_->start(number_ - 1);
  while (rings_->grow()) continue;
  for (const int cell : rings_->cells()) is_checked_[std::size_t(cell)] = 1;
  const std::vector<Index> body = rings_->nodes();
  if (!span_space(*input_.nodes, body, massive_nodes_of(body))) refuse(nodes, body);
}

CellExtension Builder::extend_from(const std::vector<Index>& nodes, std::vector<Index> donors) const {
  CellExtension result;
  result.donors = std::move(donors);
  extrapolate(nodes, result);
  return result;
}

std::vector<Index> Builder::massive_nodes_of(const std::vector<Index>& nodes) const {
  std::vector<Index> result;
  for (const Index node : nodes) {
    if (!is_contact(node)) result.push_back(node);
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// With the columns a_j = (1, x_j − x̄) of A and T = diag(m_jj), computes the w with A w = (1, x_c − x̄) and
/// the least Σ w_j²/m_jj: w = T^½ v with the least-norm v of A T^½ v = (1, x_c − x̄). Leaves Σ|w| infinite if
/// the donors do not span space.
void Builder::extrapolate(const std::vector<Index>& nodes, CellExtension& extension) const {
  const Index dimension = input_.nodes->rows();
  const auto count = Index(extension.donors.size());
  if (count <= dimension) return;
  Vector centre = Vector::Zero(dimension), scale(count);
  for (Index k = 0; k < count; ++k) {
    const Index donor = extension.donors[std::size_t(k)];
    centre += input_.nodes->col(donor) / double(count);
    scale[k] = inertia_diagonal_[donor];
  }
  scale = (scale / scale.maxCoeff()).cwiseSqrt();
  Matrix conditions(dimension + 1, count);
  for (Index k = 0; k < count; ++k) {
    conditions(0, k) = 1.0;
    conditions.col(k).tail(dimension) = input_.nodes->col(extension.donors[std::size_t(k)]) - centre;
  }
  const double size = conditions.bottomRows(dimension).cwiseAbs().maxCoeff();
  conditions.bottomRows(dimension) /= size;
  const LeastNormSolver solver(conditions * scale.asDiagonal());
  if (solver.rank() <= dimension) return;
  extension.rows.setZero(Index(nodes.size()), count);
  Vector target(dimension + 1);
  target[0] = 1.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_contact(nodes[i])) {
      const auto own = std::ranges::lower_bound(extension.donors, nodes[i]);
      extension.rows(Index(i), own - extension.donors.begin()) = 1.0;
      continue;
    }
    target.tail(dimension) = (input_.nodes->col(nodes[i]) - centre) / size;
    Vector weights = scale.cwiseProduct(solver.solve(target));
    // One step of iterative refinement, for flat cells.
    weights += scale.cwiseProduct(solver.solve(target - conditions * weights));
    largest = std::max(largest, weights.lpNorm<1>());
    extension.rows.row(Index(i)) = weights.transpose();
  }
  if (std::isfinite(largest)) extension.weights = largest;
}

void Builder::refuse(const std::vector<Index>& nodes, const std::vector<Index>& body) const {
  const Index node = *std::ranges::find_if(nodes, [this](Index n) { return is_contact(n); });
  throw Error(
      ErrorKind::invalid_input,
      fmt::format(
          "mass type \"equivalent-compact\": the inertia of the contact node at {} cannot be moved to other nodes: its "
          "body has {}; refine the mesh there or set mesh.degree = 2, so that at least {} nodes that are not all {} "
          "are off the contact boundary, or name only facets that may touch in the contact group (mass types "
          "\"consistent\" and \"lumped\", with scheme \"contact-stabilized\" or \"newmark\", have no such requirement)",
          text_of_point(*input_.nodes, node), describe_massive_nodes(*input_.nodes, body, massive_nodes_of(body)),
          input_.nodes->rows() + 1, input_.nodes->rows() == 3 ? "in one plane" : "on one line"));
}

SparseMatrix build_compact_equivalent_mass(const MassInput& input, const Parameters&) {
  input.require_cells("equivalent-compact");
  SparseMatrix result = Builder(input).build();
  check_moments(input, result, "equivalent-compact");
  return result;
}

}  // namespace

MassRegistration compact_equivalent_mass() {
  return {"equivalent-compact", {.build = build_compact_equivalent_mass, .removes_contact_inertia = true}};
}

}  // namespace ricochet
