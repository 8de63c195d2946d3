#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Weights of one contact node on free nodes.
struct Extrapolation {
  std::vector<Index> nodes;
  Vector weights;
};

/// The rows of E that differ from the identity, and the columns.
class ExtensionRows {
 public:
  explicit ExtensionRows(Index count) : row_(static_cast<std::size_t>(count), -1), column_(row_.size()) {}
  void set(Index node, Extrapolation extrapolation) {
    row_[static_cast<std::size_t>(node)] = static_cast<int>(rows_.size());
    for (std::size_t k = 0; k < extrapolation.nodes.size(); ++k) {
      column_[static_cast<std::size_t>(extrapolation.nodes[k])].push_back(
          {node, extrapolation.weights[static_cast<Index>(k)]});
    }
    rows_.push_back(std::move(extrapolation));
  }
  struct Entry {
    Index node;
    double weight;
  };
  /// The contact nodes that give some of their mass to a free node.
  [[nodiscard]] const std::vector<Entry>& column(Index node) const { return column_[static_cast<std::size_t>(node)]; }
  /// Of a contact node.
  [[nodiscard]] const Extrapolation& row(Index node) const {
    return rows_[static_cast<std::size_t>(row_[static_cast<std::size_t>(node)])];
  }

 private:
  std::vector<int> row_;  ///< per node: its entry in rows_, or −1
  std::vector<Extrapolation> rows_;
  std::vector<std::vector<Entry>> column_;
};

/// A sparse row.
struct SparseRow {
  std::vector<int> columns;
  std::vector<double> values;
};

/// One row of EᵀME at a time.
class CongruenceRow {
 public:
  /// `products`: rows of ME of the contact nodes, by node; those of other nodes are empty.
  CongruenceRow(const SparseMatrix& mass, const std::vector<char>& is_contact, const ExtensionRows& extension,
                const std::vector<SparseRow>& products)
      : mass_(mass),
        is_contact_(is_contact),
        extension_(extension),
        products_(products),
        values_(Vector::Zero(mass.cols())),
        present_(is_contact.size(), 0) {}

  /// Columns of the row, ascending; `value` gives its entries until the next call.
  const std::vector<int>& compute(Index node) {
    clear();
    if (is_contact_[static_cast<std::size_t>(node)] != 0) return columns_;
    add_product(node);
    for (const ExtensionRows::Entry& entry : extension_.column(node)) {
      const SparseRow& row = products_[static_cast<std::size_t>(entry.node)];
      for (std::size_t k = 0; k < row.columns.size(); ++k) add(row.columns[k], entry.weight * row.values[k]);
    }
    std::sort(columns_.begin(), columns_.end());
    return columns_;
  }
  [[nodiscard]] double value(int column) const { return values_[column]; }

  /// (ME)(node, ·).
  SparseRow product(Index node) {
    clear();
    add_product(node);
    SparseRow row{columns_, {}};
    for (const int column : columns_) row.values.push_back(values_[column]);
    return row;
  }

 private:
  void clear() {
    for (const int column : columns_) {
      present_[static_cast<std::size_t>(column)] = 0;
      values_[column] = 0.0;
    }
    columns_.clear();
  }
  void add(Index column, double value) {
    values_[column] += value;
    if (present_[static_cast<std::size_t>(column)] != 0) return;
    present_[static_cast<std::size_t>(column)] = 1;
    columns_.push_back(static_cast<int>(column));
  }
  void add_product(Index node) {
    for (SparseMatrix::InnerIterator entry(mass_, node); entry; ++entry) {
      if (is_contact_[static_cast<std::size_t>(entry.row())] == 0) {
        add(entry.row(), entry.value());
        continue;
      }
      const Extrapolation& row = extension_.row(entry.row());
      for (std::size_t k = 0; k < row.nodes.size(); ++k) {
        add(row.nodes[k], entry.value() * row.weights[static_cast<Index>(k)]);
      }
    }
  }

  const SparseMatrix& mass_;
  const std::vector<char>& is_contact_;
  const ExtensionRows& extension_;
  const std::vector<SparseRow>& products_;
  Vector values_;
  std::vector<char> present_;
  std::vector<int> columns_;
};

/// (A + Aᵀ)/2 of a matrix whose pattern is symmetric.
void symmetrize(SparseMatrix& matrix) {
  const int* outer = matrix.outerIndexPtr();
  const int* inner = matrix.innerIndexPtr();
  double* values = matrix.valuePtr();
  parallel_ranges(matrix.cols(), [&](Index first, Index last) {
    for (Index column = first; column < last; ++column) {
      for (int k = outer[column]; k < outer[column + 1] && inner[k] < column; ++k) {
        // Each pair is met once, from its larger index.
        const int* other =
            std::lower_bound(inner + outer[inner[k]], inner + outer[inner[k] + 1], static_cast<int>(column));
        double& transposed = values[other - inner];
        values[k] = transposed = 0.5 * (values[k] + transposed);
      }
    }
  });
}

/// EᵀME, exactly symmetric.
SparseMatrix congruence(const SparseMatrix& mass, const std::vector<char>& is_contact, const ExtensionRows& extension) {
  const Index count = mass.cols();
  SparseMatrix result(count, count);
  int* outer = result.outerIndexPtr();
  std::vector<SparseRow> products(static_cast<std::size_t>(count));
  parallel_ranges(count, [&](Index first, Index last) {
    CongruenceRow row(mass, is_contact, extension, products);
    for (Index node = first; node < last; ++node) {
      if (is_contact[static_cast<std::size_t>(node)] != 0) products[static_cast<std::size_t>(node)] = row.product(node);
    }
  });
  parallel_ranges(count, [&](Index first, Index last) {
    CongruenceRow row(mass, is_contact, extension, products);
    for (Index node = first; node < last; ++node) outer[node + 1] = static_cast<int>(row.compute(node).size());
  });
  for (Index node = 0; node < count; ++node) outer[node + 1] += outer[node];
  result.resizeNonZeros(outer[count]);
  parallel_ranges(count, [&](Index first, Index last) {
    CongruenceRow row(mass, is_contact, extension, products);
    for (Index node = first; node < last; ++node) {
      Index position = outer[node];
      for (const int column : row.compute(node)) {
        result.innerIndexPtr()[position] = column;
        result.valuePtr()[position++] = row.value(column);
      }
    }
  });
  // Entries (i, j) and (j, i) are sums in different orders; what follows relies on exact symmetry.
  symmetrize(result);
  return result;
}

/// (1, x_j − x_c) of some nodes in its columns, in the weights t_j = m_jj. Weights w = T Aᵀ y with (A T Aᵀ) y = e₁
/// reproduce affine functions and are least in Σ w_j²/t_j.
class AffineFit {
 public:
  AffineFit(const MassInput& input, const Vector& diagonal, Index node, const std::vector<Index>& free)
      : conditions_(input.nodes->rows() + 1, static_cast<Index>(free.size())), trust_(conditions_.cols()) {
    const Index dimension = input.nodes->rows();
    for (Index k = 0; k < trust_.size(); ++k) {
      conditions_(0, k) = 1.0;
      conditions_.col(k).tail(dimension) = input.nodes->col(free[static_cast<std::size_t>(k)]) - input.nodes->col(node);
      trust_[k] = diagonal[free[static_cast<std::size_t>(k)]];
    }
    // Lengths relative to the neighbourhood's size, masses to the largest: no number here has a unit.
    conditions_.bottomRows(dimension) /= conditions_.bottomRows(dimension).cwiseAbs().maxCoeff();
    trust_ /= trust_.maxCoeff();
  }

  /// False where the nodes do not span space affinely, or barely so.
  ///
  /// The test must not depend on how flat the cells are. An affine map of the mesh changes neither w nor
  ///   Σ t_j Σ w_j²/t_j = Σ t_j e₁ᵀ(A T Aᵀ)⁻¹e₁ = 1 + D²,
  /// where D is the distance of the contact node from the nodes' centre of gravity, in units of their own root mean
  /// square spread in that direction: it is this that says how far the weights extrapolate.
  bool solve(Vector& weights) const {
    const Index size = conditions_.rows();
    if (conditions_.cols() < size) return false;
    const Matrix gram = conditions_ * trust_.asDiagonal() * conditions_.transpose();
    const PivotedCholesky factor(gram);
    if (!spans_space(gram, factor)) return false;
    const Vector wanted = Vector::Unit(size, 0);
    Vector solution = factor.solve(wanted);
    weights = trust_.asDiagonal() * (conditions_.transpose() * solution);
    // In flat cells that are askew rounding leaves something to do. What is missing is measured like D.
    for (int round = 0; round < 3; ++round) {
      const Vector missing = wanted - conditions_ * weights;
      const Vector correction = factor.solve(missing);
      if (!(missing.dot(correction) > rounding * rounding * solution[0])) break;
      solution += correction;
      weights = trust_.asDiagonal() * (conditions_.transpose() * solution);
    }
    return trust_.sum() * solution[0] <= 1.0 + largest_distance * largest_distance;
  }

 private:
  /// A pivot is what is left of a row's square without the rows before: of a row that depends on them, rounding.
  static bool spans_space(const Matrix& gram, const PivotedCholesky& factor) {
    const Vector whole = factor.permuted(gram.diagonal());
    return (factor.pivots().array() > smallest_pivot * whole.array()).all();
  }

  static constexpr double rounding = 1e-13;
  static constexpr double smallest_pivot = 1e-12;
  static constexpr double largest_distance = 100.0;
  Matrix conditions_;
  Vector trust_;
};

/// M₀ = EᵀME. E is the identity on free nodes; the row of a contact node holds the weights on nearby free nodes which
/// reproduce affine functions and are least in the norm Σ w_j²/m_jj. So PᵃᵀM₀Pᵇ = PᵃᵀMPᵇ exactly, M₀ is positive
/// semi-definite with the contact dofs as its null space by construction, and wᵀ(m_cc)w measures what is added to the
/// free nodes relative to the mass they have: the choice of norm and of many neighbours keeps the top eigenvalue low.
/// See docs/equivalent-mass.md for the measurements behind `wanted_neighbours`.
class EquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }
  /// Where this one would couple so many nodes in space that a factor of the stage's operator is several times as
  /// large: 4.7 times on a ball of degree 2 with 9,054 contact nodes (docs/equivalent-mass.md). Contact nodes of all
  /// bodies count together, as the factor is one.
  [[nodiscard]] std::string cheaper_for(const MassInput& input) const override {
    constexpr std::size_t many_contact_nodes = 2000;
    const bool couples_many = input.nodes->rows() == 3 && input.contact_nodes.size() > many_contact_nodes;
    return couples_many ? "equivalent-compact" : "";
  }

  [[nodiscard]] SparseMatrix build(const MassInput& input) const override {
    const SparseMatrix& consistent = *input.consistent;
    const Index count = consistent.cols();
    std::vector<char> is_contact(static_cast<std::size_t>(count), 0);
    for (const Index node : input.contact_nodes) is_contact[static_cast<std::size_t>(node)] = 1;
    const Vector diagonal = input.inertia_matrix().diagonal();
    ExtensionRows extension(count);
    std::vector<Index> seen_from(static_cast<std::size_t>(count), -1);
    for (const Index node : input.contact_nodes) {
      extension.set(node, extrapolate(input, is_contact, diagonal, node, seen_from));
    }
    SparseMatrix result = congruence(consistent, is_contact, extension);
    check_conditions(input, result);
    return result;
  }

 private:
  /// Weights on the rings of free nodes around a contact node: enough rings to have the wanted number of neighbours and
  /// to span space affinely. `seen_from` is work space: the contact node from which a node was last reached.
  static Extrapolation extrapolate(const MassInput& input, const std::vector<char>& is_contact, const Vector& diagonal,
                                   Index node, std::vector<Index>& seen_from) {
    const Index dimension = input.nodes->rows();
    const std::size_t wanted_neighbours = dimension == 2 ? 20 : 40;
    std::vector<Index> front{node}, next, free;
    seen_from[static_cast<std::size_t>(node)] = node;
    Extrapolation result;
    while (!front.empty()) {
      next.clear();
      for (const Index from : front) {
        for (SparseMatrix::InnerIterator entry(*input.consistent, from); entry; ++entry) {
          const auto neighbour = static_cast<Index>(entry.row());
          if (seen_from[static_cast<std::size_t>(neighbour)] == node) continue;
          seen_from[static_cast<std::size_t>(neighbour)] = node;
          next.push_back(neighbour);
          if (is_contact[static_cast<std::size_t>(neighbour)] == 0) free.push_back(neighbour);
        }
      }
      std::swap(front, next);
      const bool enough = free.size() >= wanted_neighbours || front.empty();
      if (enough && !free.empty() && AffineFit(input, diagonal, node, free).solve(result.weights)) {
        result.nodes = std::move(free);
        return result;
      }
    }
    refuse(input, node, free);
  }

  [[noreturn]] static void refuse(const MassInput& input, Index node, std::vector<Index>& free) {
    std::sort(free.begin(), free.end());
    const bool flat = free.empty() || !degeneracy(*input.nodes, free).empty();
    throw Error(ErrorKind::invalid_input,
                fmt::format("mass type \"equivalent\": the inertia of the contact node at {} cannot be moved to other "
                            "nodes: its body has {}{}; refine the mesh there or set mesh.degree = 2, so that {} nodes "
                            "that are not all {} are off the contact boundary, or name only facets that may touch in "
                            "the contact group (mass types \"consistent\" and \"lumped\" need none of this)",
                            text_of_point(*input.nodes, node), describe_free_nodes(*input.nodes, free),
                            flat ? "" : ", which are too close together for their distance from it",
                            input.nodes->rows() == 3 ? "at least 4" : "at least 3",
                            input.nodes->rows() == 3 ? "in one plane" : "on one line"));
  }

  /// Total mass, centre of gravity and moments of inertia follow from the weights; rounding leaves 1e-13 of them.
  static void check_conditions(const MassInput& input, const SparseMatrix& mass) {
    const MassFrames frames = mass_frames(input.inertia_matrix(), *input.nodes);
    const MassBody* worst = nullptr;
    const double defect = moment_defect(mass, *input.consistent, frames, &worst);
    if (defect <= 1e-10) return;
    throw Error(ErrorKind::invalid_input,
                fmt::format("mass type \"equivalent\": the moments of inertia of the body with the node at {} would be "
                            "off by {:.2g} of the largest, because its mesh is too distorted for this construction; "
                            "improve the mesh around the contact boundary, or use mass type \"consistent\" or "
                            "\"lumped\"",
                            text_of_point(*input.nodes, worst->nodes.front()), defect));
  }
};

}  // namespace

MassRegistration equivalent_mass() {
  return {"equivalent", [](const Parameters&) { return std::make_unique<EquivalentMass>(); }};
}

}  // namespace ricochet
