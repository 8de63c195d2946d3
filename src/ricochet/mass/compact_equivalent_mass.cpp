#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Σ|w| of a contact node for which more donors are not looked for. Weights that extrapolate have both signs; on
/// straight simplices of degree 2 that have a facet on the contact boundary they are 2, −1 or 1, 1, −1.
constexpr double small_weights = 4.0;
/// After so many rings of cells these are good enough.
constexpr std::size_t many_rings = 4;
constexpr double fair_weights = 10.0;

/// Cells in rings around one, by the facets that they share. Each ring costs what it adds.
class CellRings {
 public:
  CellRings(const CellMasses& cells, Index node_count) : at_node_(static_cast<std::size_t>(node_count)) {
    cells.for_each_cell([&](const std::vector<Index>& nodes) {
      for (const Index node : nodes)
        at_node_[static_cast<std::size_t>(node)].push_back(static_cast<int>(nodes_.size()));
      nodes_.push_back(nodes);
    });
    facet_nodes_ = cells.least_facet_nodes();
    common_.assign(nodes_.size(), 0);
    stamp_.assign(nodes_.size(), 0);
  }

  /// The cell alone.
  void start(int cell) {
    ++run_;
    cells_.assign(1, cell);
    stamp_[static_cast<std::size_t>(cell)] = run_;
    frontier_ = 0;
  }
  /// Adds the cells that share a facet with those of the outermost ring; false where there are none.
  bool grow() {
    const std::size_t before = cells_.size();
    for (; frontier_ < before; ++frontier_) add_neighbours(cells_[frontier_]);
    return cells_.size() > before;
  }
  [[nodiscard]] const std::vector<int>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<Index>& nodes(int cell) const { return nodes_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] std::size_t count() const { return nodes_.size(); }

 private:
  void add_neighbours(int cell) {
    met_.clear();
    for (const Index node : nodes(cell)) {
      for (const int other : at_node_[static_cast<std::size_t>(node)]) {
        if (common_[static_cast<std::size_t>(other)]++ == 0) met_.push_back(other);
      }
    }
    for (const int other : met_) {
      const auto at = static_cast<std::size_t>(other);
      if (common_[at] >= facet_nodes_ && stamp_[at] != run_) {
        stamp_[at] = run_;
        cells_.push_back(other);
      }
      common_[at] = 0;
    }
  }

  std::vector<std::vector<int>> at_node_;
  std::vector<std::vector<Index>> nodes_;
  int facet_nodes_ = 0;
  std::vector<int> cells_;    ///< ring after ring
  std::size_t frontier_ = 0;  ///< the first of the outermost ring
  std::vector<int> stamp_;    ///< per cell: the run that added it last
  int run_ = 0;
  std::vector<int> common_;  ///< per cell: nodes in common with the one that is looked at, else 0
  std::vector<int> met_;
};

/// The extension of a cell: its contact nodes follow free nodes of its own, or of it and its neighbours.
struct CellExtension {
  std::vector<Index> donors;                                 ///< ascending
  Matrix rows;                                               ///< E_e, nodes of the cell × donors
  double weights = std::numeric_limits<double>::infinity();  ///< the largest Σ|w|
};

class CompactEquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }
  [[nodiscard]] SparseMatrix build(const MassInput& input) const override;
};

/// Builds one mass.
class Builder {
 public:
  explicit Builder(const MassInput& input);
  SparseMatrix build();

 private:
  void empty_result();
  void add_cell(const std::vector<Index>& nodes, const Matrix& mass);
  void add_value(Index row, Index column, double value);
  CellExtension extend(const std::vector<Index>& nodes);
  [[nodiscard]] CellExtension extend_from(const std::vector<Index>& nodes, std::vector<Index> donors) const;
  void require_free_nodes_of_body(const std::vector<Index>& nodes);
  [[nodiscard]] std::vector<Index> free_nodes_of(const std::vector<Index>& nodes) const;
  [[nodiscard]] std::vector<Index> free_nodes_around(const std::vector<int>& cells) const;
  void extrapolate(const std::vector<Index>& nodes, CellExtension& extension) const;
  [[nodiscard]] bool is_contact(Index node) const { return is_contact_[static_cast<std::size_t>(node)] != 0; }
  [[noreturn]] void refuse(const std::vector<Index>& nodes, const std::vector<Index>& free) const;

  const MassInput& input_;
  std::vector<char> is_contact_;
  Vector trust_;  ///< m_jj
  std::unique_ptr<CellRings> rings_;
  std::vector<char> is_checked_;                ///< per cell: the free nodes of its body span space
  SparseMatrix result_;                         ///< on the pattern of M
  std::vector<Eigen::Triplet<double>> beyond_;  ///< what is not in it
  int number_ = 0;                              ///< of the cell
};

Builder::Builder(const MassInput& input) : input_(input), trust_(input.inertia_matrix().diagonal()) {
  is_contact_.assign(static_cast<std::size_t>(input.consistent->cols()), 0);
  for (const Index node : input.contact_nodes) is_contact_[static_cast<std::size_t>(node)] = 1;
}

/// The rows and columns of free nodes of M, with zeros.
void Builder::empty_result() {
  const SparseMatrix& mass = input_.inertia_matrix();
  result_.resize(mass.rows(), mass.cols());
  int* outer = result_.outerIndexPtr();
  for (int pass = 0; pass < 2; ++pass) {
    int position = 0;
    for (Index column = 0; column < mass.cols(); ++column) {
      outer[column] = position;
      if (is_contact(column)) continue;
      for (SparseMatrix::InnerIterator entry(mass, column); entry; ++entry) {
        if (is_contact(entry.row())) continue;
        if (pass > 0) {
          result_.innerIndexPtr()[position] = static_cast<int>(entry.row());
          result_.valuePtr()[position] = 0.0;
        }
        ++position;
      }
    }
    outer[mass.cols()] = position;
    if (pass == 0) result_.resizeNonZeros(position);
  }
}

void Builder::add_value(Index row, Index column, double value) {
  const int* begin = result_.innerIndexPtr() + result_.outerIndexPtr()[column];
  const int* end = result_.innerIndexPtr() + result_.outerIndexPtr()[column + 1];
  const int* at = std::lower_bound(begin, end, static_cast<int>(row));
  if (at != end && *at == row) {
    result_.valuePtr()[at - result_.innerIndexPtr()] += value;
  } else {
    beyond_.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  }
}

SparseMatrix Builder::build() {
  empty_result();
  input_.cells->for_each([this](const std::vector<Index>& nodes, const Matrix& mass) { add_cell(nodes, mass); });
  if (!beyond_.empty()) {
    SparseMatrix beyond(result_.rows(), result_.cols());
    beyond.setFromTriplets(beyond_.begin(), beyond_.end());
    add_sparse(result_, beyond).swap(result_);
  }
  return std::move(result_);
}

/// E_eᵀ m_e E_e.
void Builder::add_cell(const std::vector<Index>& nodes, const Matrix& mass) {
  ++number_;
  const auto count = static_cast<Index>(nodes.size());
  if (std::none_of(nodes.begin(), nodes.end(), [this](Index node) { return is_contact(node); })) {
    for (Index j = 0; j < count; ++j) {
      for (Index i = 0; i < count; ++i)
        add_value(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)], mass(i, j));
    }
    return;
  }
  const CellExtension extension = extend(nodes);
  const Matrix moved = extension.rows.transpose() * mass * extension.rows;
  const auto donors = static_cast<Index>(extension.donors.size());
  for (Index j = 0; j < donors; ++j) {
    for (Index i = 0; i < donors; ++i) {
      add_value(extension.donors[static_cast<std::size_t>(i)], extension.donors[static_cast<std::size_t>(j)],
                0.5 * (moved(i, j) + moved(j, i)));
    }
  }
}

/// From the cell's own free nodes if they are enough, else from more and more rings of cells.
CellExtension Builder::extend(const std::vector<Index>& nodes) {
  CellExtension best = extend_from(nodes, free_nodes_of(nodes));
  if (best.weights <= small_weights) return best;
  if (!rings_) rings_ = std::make_unique<CellRings>(*input_.cells, input_.consistent->cols());
  require_free_nodes_of_body(nodes);
  rings_->start(number_ - 1);
  for (std::size_t ring = 1; rings_->grow(); ++ring) {
    CellExtension extension = extend_from(nodes, free_nodes_around(rings_->cells()));
    if (extension.weights < best.weights) std::swap(best, extension);
    if (best.weights <= (ring < many_rings ? small_weights : fair_weights)) return best;
  }
  if (!std::isfinite(best.weights)) refuse(nodes, free_nodes_around(rings_->cells()));
  return best;  // all free nodes of the body
}

/// Refuses, once per body, what no number of rings would mend: they would grow to the whole body, cell after cell.
void Builder::require_free_nodes_of_body(const std::vector<Index>& nodes) {
  if (is_checked_.empty()) is_checked_.assign(rings_->count(), 0);
  if (is_checked_[static_cast<std::size_t>(number_ - 1)] != 0) return;
  rings_->start(number_ - 1);
  while (rings_->grow()) continue;
  std::vector<Index> body;
  for (const int cell : rings_->cells()) {
    is_checked_[static_cast<std::size_t>(cell)] = 1;
    body.insert(body.end(), rings_->nodes(cell).begin(), rings_->nodes(cell).end());
  }
  std::sort(body.begin(), body.end());
  body.erase(std::unique(body.begin(), body.end()), body.end());
  const std::vector<Index> free = free_nodes_of(body);
  if (!span_space(*input_.nodes, body, free)) refuse(nodes, free);
}

CellExtension Builder::extend_from(const std::vector<Index>& nodes, std::vector<Index> donors) const {
  CellExtension result;
  result.donors = std::move(donors);
  extrapolate(nodes, result);
  return result;
}

std::vector<Index> Builder::free_nodes_of(const std::vector<Index>& nodes) const {
  std::vector<Index> result;
  for (const Index node : nodes) {
    if (!is_contact(node)) result.push_back(node);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Index> Builder::free_nodes_around(const std::vector<int>& cells) const {
  std::vector<Index> nodes;
  for (const int cell : cells) nodes.insert(nodes.end(), rings_->nodes(cell).begin(), rings_->nodes(cell).end());
  return free_nodes_of(nodes);
}

/// With the columns a_j = (1, x_j − x̄) of A and T = diag(m_jj), the w with A w = (1, x_c − x̄) that are least in
/// Σ w_j²/m_jj: w = T^½ v with the least v of A T^½ v = (1, x_c − x̄). Leaves Σ|w| infinite where the donors do not
/// span space.
void Builder::extrapolate(const std::vector<Index>& nodes, CellExtension& extension) const {
  const Index dimension = input_.nodes->rows();
  const auto count = static_cast<Index>(extension.donors.size());
  if (count <= dimension) return;
  Vector centre = Vector::Zero(dimension), scale(count);
  for (Index k = 0; k < count; ++k) {
    const Index donor = extension.donors[static_cast<std::size_t>(k)];
    centre += input_.nodes->col(donor) / static_cast<double>(count);
    scale[k] = trust_[donor];
  }
  scale = (scale / scale.maxCoeff()).cwiseSqrt();
  Matrix conditions(dimension + 1, count);
  for (Index k = 0; k < count; ++k) {
    conditions(0, k) = 1.0;
    conditions.col(k).tail(dimension) = input_.nodes->col(extension.donors[static_cast<std::size_t>(k)]) - centre;
  }
  const double size = conditions.bottomRows(dimension).cwiseAbs().maxCoeff();
  conditions.bottomRows(dimension) /= size;
  const LeastNormSolver solver(conditions * scale.asDiagonal());
  if (solver.rank() <= dimension) return;
  extension.rows.setZero(static_cast<Index>(nodes.size()), count);
  Vector wanted(dimension + 1);
  wanted[0] = 1.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_contact(nodes[i])) {
      const auto own = std::lower_bound(extension.donors.begin(), extension.donors.end(), nodes[i]);
      extension.rows(static_cast<Index>(i), own - extension.donors.begin()) = 1.0;
      continue;
    }
    wanted.tail(dimension) = (input_.nodes->col(nodes[i]) - centre) / size;
    Vector weights = scale.cwiseProduct(solver.solve(wanted));
    // In flat cells rounding leaves something to do.
    weights += scale.cwiseProduct(solver.solve(wanted - conditions * weights));
    largest = std::max(largest, weights.lpNorm<1>());
    extension.rows.row(static_cast<Index>(i)) = weights.transpose();
  }
  if (std::isfinite(largest)) extension.weights = largest;
}

void Builder::refuse(const std::vector<Index>& nodes, const std::vector<Index>& free) const {
  const Index node = *std::find_if(nodes.begin(), nodes.end(), [this](Index n) { return is_contact(n); });
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("mass type \"equivalent-compact\": the inertia of the contact node at {} cannot be moved to other "
                  "nodes: its body has {}; refine the mesh there or set mesh.degree = 2, so that at least {} nodes "
                  "that are not all {} "
                  "are off the contact boundary, or name only facets that may touch in the contact group (mass types "
                  "\"consistent\" and \"lumped\" need none of this)",
                  text_of_point(*input_.nodes, node), describe_free_nodes(*input_.nodes, free),
                  input_.nodes->rows() + 1, input_.nodes->rows() == 3 ? "in one plane" : "on one line"));
}

/// The moments follow from the weights; rounding leaves 1e-13 of them.
void check_conditions(const MassInput& input, const SparseMatrix& mass) {
  const MassFrames frames = mass_frames(input.inertia_matrix(), *input.nodes);
  const MassBody* worst = nullptr;
  const double defect = moment_defect(mass, *input.consistent, frames, &worst);
  if (defect <= 1e-10) return;
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("mass type \"equivalent-compact\": the moments of inertia of the body with the node at {} would "
                  "be off by {:.2g} of the largest, because its mesh is too distorted for this construction; "
                  "improve the mesh around the contact boundary, or use mass type \"consistent\" or \"lumped\"",
                  text_of_point(*input.nodes, worst->nodes.front()), defect));
}

SparseMatrix CompactEquivalentMass::build(const MassInput& input) const {
  if (input.cells == nullptr)
    throw Error(ErrorKind::invalid_input, "mass type \"equivalent-compact\" needs the masses of single cells");
  SparseMatrix result = Builder(input).build();
  check_conditions(input, result);
  return result;
}

}  // namespace

MassRegistration compact_equivalent_mass() {
  return {"equivalent-compact", [](const Parameters&) { return std::make_unique<CompactEquivalentMass>(); }};
}

}  // namespace ricochet
