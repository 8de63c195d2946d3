#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/mass/affine_fit.hpp"
#include "ricochet/mass/graph_rings.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Weights of one contact node on massive nodes.
struct Extrapolation {
  std::vector<int> nodes;
  Vector weights;
};

/// Rows of E that differ from the identity, and their columns.
class ExtensionRows {
 public:
  explicit ExtensionRows(Index count) : row_(std::size_t(count), -1), column_(row_.size()) {}
  void set(Index node, Extrapolation extrapolation) {
    row_[std::size_t(node)] = int(rows_.size());
    for (std::size_t k = 0; k < extrapolation.nodes.size(); ++k) {
      column_[std::size_t(extrapolation.nodes[k])].push_back({node, extrapolation.weights[Index(k)]});
    }
    rows_.push_back(std::move(extrapolation));
  }
  struct Entry {
    Index node;
    double weight;
  };
  /// Contact nodes that contribute mass to a massive node.
  [[nodiscard]] const std::vector<Entry>& column(Index node) const { return column_[std::size_t(node)]; }
  /// Row of a contact node.
  [[nodiscard]] const Extrapolation& row(Index node) const { return rows_[std::size_t(row_[std::size_t(node)])]; }

 private:
  std::vector<int> row_;  ///< per node: its entry in rows_, or −1
  std::vector<Extrapolation> rows_;
  std::vector<std::vector<Entry>> column_;
};

/// Sparse row.
struct SparseRow {
  std::vector<int> columns;
  std::vector<double> values;
};

/// Computes one row of EᵀME at a time.
class CongruenceRow {
 public:
  /// `products`: rows of ME for the contact nodes, by node; empty for other nodes.
  CongruenceRow(const SparseMatrix& mass, const std::vector<char>& is_contact, const ExtensionRows& extension,
                const std::vector<SparseRow>& products)
      : mass_(mass),
        is_contact_(is_contact),
        extension_(extension),
        products_(products),
        values_(Vector::Zero(mass.cols())),
        present_(is_contact.size(), 0) {}

  /// Returns the columns of the row, ascending; `value` returns its entries until the next call.
  const std::vector<int>& compute(Index node) {
    clear();
    if (is_contact_[std::size_t(node)] != 0) return columns_;
    add_product(node);
    for (const ExtensionRows::Entry& entry : extension_.column(node)) {
      const SparseRow& row = products_[std::size_t(entry.node)];
      for (std::size_t k = 0; k < row.columns.size(); ++k) add(row.columns[k], entry.weight * row.values[k]);
    }
    std::ranges::sort(columns_);
    return columns_;
  }
  [[nodiscard]] double value(int column) const { return values_[column]; }

  /// Returns (ME)(node, ·).
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
      present_[std::size_t(column)] = 0;
      values_[column] = 0.0;
    }
    columns_.clear();
  }
  void add(Index column, double value) {
    values_[column] += value;
    if (present_[std::size_t(column)] != 0) return;
    present_[std::size_t(column)] = 1;
    columns_.push_back(int(column));
  }
  void add_product(Index node) {
    for (SparseMatrix::InnerIterator entry(mass_, node); entry; ++entry) {
      if (is_contact_[std::size_t(entry.row())] == 0) {
        add(entry.row(), entry.value());
        continue;
      }
      const Extrapolation& row = extension_.row(entry.row());
      for (std::size_t k = 0; k < row.nodes.size(); ++k) {
        add(row.nodes[k], entry.value() * row.weights[Index(k)]);
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

/// Replaces A by (A + Aᵀ)/2; its pattern must be symmetric.
void symmetrize(SparseMatrix& matrix) {
  const int* outer = matrix.outerIndexPtr();
  const int* inner = matrix.innerIndexPtr();
  double* values = matrix.valuePtr();
  parallel_ranges(matrix.cols(), [&](Index first, Index last) {
    for (Index column = first; column < last; ++column) {
      for (int k = outer[column]; k < outer[column + 1] && inner[k] < column; ++k) {
        // Each pair is visited once, from its larger index.
        const int* other = std::lower_bound(inner + outer[inner[k]], inner + outer[inner[k] + 1], int(column));
        double& transposed = values[other - inner];
        values[k] = transposed = 0.5 * (values[k] + transposed);
      }
    }
  });
}

/// Returns EᵀME, exactly symmetric.
SparseMatrix congruence(const SparseMatrix& mass, const std::vector<char>& is_contact, const ExtensionRows& extension) {
  const Index count = mass.cols();
  SparseMatrix result(count, count);
  int* outer = result.outerIndexPtr();
  std::vector<SparseRow> products(static_cast<std::size_t>(count));
  parallel_ranges(count, [&](Index first, Index last) {
    CongruenceRow row(mass, is_contact, extension, products);
    for (Index node = first; node < last; ++node) {
      if (is_contact[std::size_t(node)] != 0) products[std::size_t(node)] = row.product(node);
    }
  });
  parallel_ranges(count, [&](Index first, Index last) {
    CongruenceRow row(mass, is_contact, extension, products);
    for (Index node = first; node < last; ++node) outer[node + 1] = int(row.compute(node).size());
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
  // Entries (i, j) and (j, i) are summed in different orders; later code relies on exact symmetry.
  symmetrize(result);
  return result;
}

/// Computes the weights that extrapolate from nodes to a point. Returns false if the nodes do not span
/// space affinely, or barely so.
///
/// The criterion must not depend on how flat the cells are. An affine map of the mesh changes neither w nor
///   Σ t_j Σ w_j²/t_j = 1 + |ξ|²,  t_j = m_jj,
/// where |ξ| is the distance of the point from the centre of gravity of the nodes, in units of their root mean square
/// spread in that direction, and measures how far the weights extrapolate.
bool extrapolation_weights(const Points& nodes, const Vector& node_weights, const std::vector<int>& of, Index point,
                           Vector& weights) {
  constexpr double largest_distance = 100.0;
  const int d = int(nodes.rows());
  AffineFrame frame;
  if (!make_affine_frame(nodes, of.data(), int(of.size()), node_weights, frame)) return false;
  double to[4] = {1.0}, weight[4];
  affine_coordinates(frame, d, nodes.col(point).data(), to + 1);
  weights.setZero(Index(of.size()));
  for (std::size_t j = 0; j < of.size(); ++j) {
    affine_weight(frame, d, nodes.col(of[j]).data(), node_weights[of[j]], weight);
    for (int k = 0; k <= d; ++k) weights[Index(j)] += weight[k] * to[k];
  }
  const double square = to[1] * to[1] + to[2] * to[2] + to[3] * to[3];
  return square <= largest_distance * largest_distance;
}

[[noreturn]] void refuse_node(const MassInput& input, Index node, const std::vector<Index>& body,
                              std::vector<Index> massive) {
  std::ranges::sort(massive);
  const bool flat = massive.empty() || !degeneracy(*input.nodes, body, massive).empty();
  throw Error(ErrorKind::invalid_input,
              fmt::format("mass type \"equivalent-nodewise\": the inertia of the contact node at {} cannot be moved "
                          "to other nodes: its body has {}{}; refine the mesh there or set mesh.degree = 2, so that "
                          "{} nodes that are not all {} are off the contact boundary, or name only facets that may "
                          "touch in the contact group (mass types \"consistent\" and \"lumped\", with scheme "
                          "\"contact-stabilized\" or \"newmark\", have no such requirement)",
                          text_of_point(*input.nodes, node), describe_massive_nodes(*input.nodes, body, massive),
                          flat ? "" : ", which are too close together for their distance from it",
                          input.nodes->rows() == 3 ? "at least 4" : "at least 3",
                          input.nodes->rows() == 3 ? "in one plane" : "on one line"));
}

/// Computes weights on the rings of massive nodes around a contact node: enough rings for the required number of
/// neighbours and to span space affinely.
Extrapolation extrapolate(const MassInput& input, const std::vector<char>& is_contact, const Vector& diagonal,
                          Index node, GraphRings& rings) {
  const Index dimension = input.nodes->rows();
  const std::size_t required_neighbours = dimension == 2 ? 20 : 40;
  std::vector<int> massive;
  Extrapolation result;
  rings.start(node);
  for (bool grows = true; grows;) {
    grows = rings.grow([&](Index neighbour) {
      if (is_contact[std::size_t(neighbour)] == 0) massive.push_back(int(neighbour));
    });
    const bool enough = massive.size() >= required_neighbours || !grows;
    if (enough && extrapolation_weights(*input.nodes, diagonal, massive, node, result.weights)) {
      result.nodes = std::move(massive);
      return result;
    }
  }
  refuse_node(input, node, rings.nodes(), {massive.begin(), massive.end()});
}

/// M₀ = EᵀME. E is the identity on massive nodes; the row of a contact node holds the weights on nearby massive nodes
/// that reproduce affine functions with the least norm Σ w_j²/m_jj. Hence PᵃᵀM₀Pᵇ = PᵃᵀMPᵇ exactly, M₀ is by
/// construction positive semi-definite with the contact dofs as its null space, and wᵀ(m_cc)w measures the mass added
/// to the massive nodes relative to their own: the choice of the norm and of many neighbours keeps the top eigenvalue
/// low. docs/equivalent-mass.md has the measurements behind `required_neighbours`.
SparseMatrix build_nodewise_equivalent_mass(const MassInput& input, const Parameters&) {
  const SparseMatrix& consistent = *input.consistent;
  const Index count = consistent.cols();
  const std::vector<char> is_contact = input.marked_contact_nodes();
  const Vector diagonal = input.inertia_matrix().diagonal();
  ExtensionRows extension(count);
  GraphRings rings(consistent);
  for (const Index node : input.contact_nodes) {
    extension.set(node, extrapolate(input, is_contact, diagonal, node, rings));
  }
  SparseMatrix result = congruence(consistent, is_contact, extension);
  check_moments(input, result, "equivalent-nodewise");
  return result;
}

}  // namespace

MassRegistration nodewise_equivalent_mass() {
  return {"equivalent-nodewise", {.build = build_nodewise_equivalent_mass, .removes_contact_inertia = true}};
}

}  // namespace ricochet
