#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/mass/affine_fit.hpp"
#include "ricochet/mass/cell_rings.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// PᵀRP with P = (1, ξ): the inertia of affine velocities in a frame. Only the first dimension + 1 rows and columns are
/// used.
using AffineInertia = std::array<std::array<double, 4>, 4>;

void add_inertia(AffineInertia& to, double factor, const AffineInertia& added) {
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) to[a][b] += factor * added[a][b];
  }
}

/// Cell with contact nodes: PᵀRP of the inertia R that it cannot keep, in the frame of its nodes.
struct ContactCell {
  int cell = 0;
  double weight = 1.0;  ///< ratio of the mass to be built to the inertia
  AffineFrame frame;
  AffineInertia inertia{};
  std::size_t first_share = 0;
};

/// A cell whose massive nodes span space affinely.
struct Donor {
  int cell = 0;
  AffineFrame frame;  ///< of its massive nodes
  AffineInertia received{};
  AffineInertia cost{};  ///< of received inertia: Σ_i L_i²/D_i (m)_ii, with m the matrix added to its massive nodes
};

/// θ_Tq, and the inertia to be shared in the frame of the donor.
struct Share {
  int donor = 0;
  double part = 0.0;
  double cost = 0.0;
  AffineInertia inertia;
};

/// Builds M₀ = Σ_massive m_T + Σ_contact [S_T + Σ_q θ_Tq W_Tqᵀ R_T W_Tq], see docs/equivalent-mass.md. Since W_Tq maps
/// to affine functions, only the moments PᵀRP of R_T are needed, and only their sum for each donor.
class CellwiseBuilder {
 public:
  explicit CellwiseBuilder(const MassInput& input);
  SparseMatrix build();

 private:
  [[nodiscard]] bool is_contact(Index node) const { return is_contact_[std::size_t(node)] != 0; }
  void add_cell(int cell, const std::vector<Index>& nodes, const Matrix& inertia, double weight);
  void keep_inertia(const std::vector<Index>& nodes, const Matrix& inertia, double weight);
  void find_donors();
  int donor_of(int cell);
  void share_out();
  void update_costs(const Vector& lengths);
  void update_parts(const ContactCell& contact_cell, std::size_t end, bool first);
  void receive(const ContactCell& contact_cell, std::size_t end, double weight);
  [[nodiscard]] Vector diagonal() const;
  void hand_over();
  template <class Visit>
  void for_each_weight(const Donor& donor, const Visit& visit) const;
  [[nodiscard]] bool transform_inertia(const Donor& donor, const ContactCell& contact_cell,
                                       AffineInertia& inertia) const;
  [[noreturn]] void refuse(const ContactCell& contact_cell);

  const MassInput& input_;
  const int d_;
  std::vector<char> is_contact_;
  Vector inertia_diagonal_;   ///< D
  Vector retained_diagonal_;  ///< diagonal of the inertia that cells keep
  SparseMatrix result_;       ///< on the pattern of M
  Matrix remains_;            ///< work space: S_T, with zero rows for contact nodes
  CellRings rings_;
  std::vector<ContactCell> contact_cells_;
  std::vector<Donor> donors_;
  std::vector<int> donor_number_;  ///< per cell; −1: not a donor, −2: not yet determined
  std::vector<Share> shares_;
};

/// Entry of two massive nodes of a cell, which the consistent mass couples.
double& entry_of(SparseMatrix& matrix, Index row, Index column) {
  double* const entry = stored_entry(matrix, row, column);
  if (entry == nullptr) throw std::logic_error("a mass does not couple two nodes of a cell");
  return *entry;
}

/// Number of donors that share the inertia of a cell: always whole rings of them, so that the order of cells does not
/// matter.
constexpr std::size_t required_donors = 3;
/// Number of updates of θ with the diagonal of the resulting mass.
constexpr int sweeps = 3;

CellwiseBuilder::CellwiseBuilder(const MassInput& input)
    : input_(input),
      d_(int(input.nodes->rows())),
      is_contact_(input.marked_contact_nodes()),
      inertia_diagonal_(input.inertia_matrix().diagonal()),
      retained_diagonal_(Vector::Zero(inertia_diagonal_.size())),
      result_(zeros_without(input.inertia_matrix(), is_contact_)),
      rings_(*input.cells, input.nodes->cols()),
      donor_number_(std::size_t(rings_.count()), -2) {}

SparseMatrix CellwiseBuilder::build() {
  const bool is_inertia = input_.consistent == &input_.inertia_matrix();
  int cell = 0;
  input_.cells->for_each_inertia([&](const std::vector<Index>& nodes, const Matrix& inertia, double weight) {
    add_cell(cell++, nodes, inertia, is_inertia ? 1.0 : weight);
  });
  find_donors();
  share_out();
  hand_over();
  return std::move(result_);
}

/// Adds m_T, of a contact cell S_T = m_FF − m_FC m_CC⁻¹ m_CF: contact nodes are eliminated one after the other, and
/// each elimination adds the removed matrix r rᵀ/m_cc, with the column r of the contact node, to R_T.
void CellwiseBuilder::add_cell(int cell, const std::vector<Index>& nodes, const Matrix& inertia, double weight) {
  const auto count = Index(nodes.size());
  if (std::ranges::none_of(nodes, [this](Index node) { return is_contact(node); }))
    return keep_inertia(nodes, inertia, weight);
  ContactCell contact_cell;
  contact_cell.cell = cell;
  contact_cell.weight = weight;
  if (!make_affine_frame(*input_.nodes, rings_.nodes(cell), int(count), inertia_diagonal_, contact_cell.frame))
    refuse(contact_cell);
  remains_ = inertia;
  for (Index c = 0; c < count; ++c) {
    if (!is_contact(nodes[std::size_t(c)])) continue;
    const double pivot = remains_(c, c);
    double moments[4] = {};
    for (Index i = 0; i < count; ++i) {
      double p[4] = {1.0};
      affine_coordinates(contact_cell.frame, d_, input_.nodes->col(nodes[std::size_t(i)]).data(), p + 1);
      for (int a = 0; a <= d_; ++a) moments[a] += remains_(i, c) * p[a];
    }
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) contact_cell.inertia[a][b] += moments[a] * moments[b] / pivot;
    }
    for (Index j = 0; j < count; ++j) {
      const double factor = remains_(j, c) / pivot;
      for (Index i = 0; i < count && j != c; ++i) remains_(i, j) -= factor * remains_(i, c);
    }
    remains_.col(c).setZero();
  }
  keep_inertia(nodes, remains_, weight);
  contact_cells_.push_back(contact_cell);
}

/// Adds the inertia that a cell keeps. Only the lower triangle of `inertia` is used.
void CellwiseBuilder::keep_inertia(const std::vector<Index>& nodes, const Matrix& inertia, double weight) {
  const auto count = Index(nodes.size());
  for (Index j = 0; j < count; ++j) {
    const Index column = nodes[std::size_t(j)];
    if (is_contact(column)) continue;
    retained_diagonal_[column] += inertia(j, j);
    for (Index i = j; i < count; ++i) {
      const Index row = nodes[std::size_t(i)];
      if (is_contact(row)) continue;
      entry_of(result_, row, column) += weight * inertia(i, j);
      if (i != j) entry_of(result_, column, row) += weight * inertia(i, j);
    }
  }
}

int CellwiseBuilder::donor_of(int cell) {
  int& number = donor_number_[std::size_t(cell)];
  if (number != -2) return number;
  std::vector<int> massive;
  for (int k = 0; k < rings_.node_count(cell); ++k) {
    if (!is_contact(rings_.nodes(cell)[k])) massive.push_back(rings_.nodes(cell)[k]);
  }
  Donor donor;
  donor.cell = cell;
  number = -1;
  if (!make_affine_frame(*input_.nodes, massive.data(), int(massive.size()), inertia_diagonal_, donor.frame))
    return number;
  donors_.push_back(donor);
  return number = int(donors_.size()) - 1;
}

/// Searches ring by ring until there are enough donors. If donors are rare, the search ends at twice the distance of
/// the first ring with one, and beyond `many_cells`: from so far away inertia is amplified more than any user would
/// accept, and searching a whole body for donors, cell after cell, would take minutes.
void CellwiseBuilder::find_donors() {
  for (ContactCell& contact_cell : contact_cells_) {
    contact_cell.first_share = shares_.size();
    rings_.start(contact_cell.cell);
    std::size_t visited = 0, ring = 0, nearest = 0;
    do {
      for (; visited < rings_.cells().size(); ++visited) {
        Share share{donor_of(rings_.cells()[visited]), 0.0, 0.0, {}};
        if (share.donor >= 0 && transform_inertia(donors_[std::size_t(share.donor)], contact_cell, share.inertia))
          shares_.push_back(share);
      }
      if (shares_.size() == contact_cell.first_share)
        nearest = ++ring;
      else if (shares_.size() - contact_cell.first_share >= required_donors || ++ring > 2 * nearest + 2)
        break;
    } while (rings_.cells().size() < CellRings::many_cells && rings_.grow());
    if (shares_.size() == contact_cell.first_share) refuse(contact_cell);
  }
}

/// Computes PᵀRP with P = (1, ξ) in the frame of the donor. Returns false if the donor's massive nodes barely span
/// space: if the root mean square distance of the contact cell's nodes exceeds a hundred times their spread in some
/// direction.
bool CellwiseBuilder::transform_inertia(const Donor& donor, const ContactCell& contact_cell,
                                        AffineInertia& inertia) const {
  constexpr double largest_distance = 100.0;
  double change[4][4] = {{1.0}}, shift[3], linear[3][3], square = 0.0;
  affine_change(contact_cell.frame, donor.frame, d_, shift, linear);
  for (int i = 0; i < d_; ++i) {
    change[i + 1][0] = shift[i];
    square += shift[i] * shift[i];
    for (int j = 0; j < d_; ++j) {
      change[i + 1][j + 1] = linear[i][j];
      square += linear[i][j] * linear[i][j];
    }
  }
  if (!(square <= largest_distance * largest_distance)) return false;
  double half[4][4];
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      half[i][j] = 0.0;
      for (std::size_t k = 0; k < 4; ++k) half[i][j] += change[i][k] * contact_cell.inertia[k][j];
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += half[i][k] * change[j][k];
      inertia[i][j] = inertia[j][i] = sum;
    }
  }
  return true;
}

/// Calls visit(node, w): Σ_i w_i v_i are the value of the affine fit at the centre of the donor and its gradient in ξ.
template <class Visit>
void CellwiseBuilder::for_each_weight(const Donor& donor, const Visit& visit) const {
  for (int k = 0; k < rings_.node_count(donor.cell); ++k) {
    const int node = rings_.nodes(donor.cell)[k];
    if (is_contact(node)) continue;
    double weight[4];
    affine_weight(donor.frame, d_, input_.nodes->col(node).data(), inertia_diagonal_[node], weight);
    visit(node, weight);
  }
}

double quadratic_form(const AffineInertia& inertia, const double* left, const double* right) {
  double result = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) result += left[a] * inertia[a][b] * right[b];
  }
  return result;
}

void CellwiseBuilder::update_costs(const Vector& lengths) {
  for (Donor& donor : donors_) {
    donor.cost = {};
    for_each_weight(donor, [&](int node, const double* weight) {
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b)
          donor.cost[a][b] += weight[a] * weight[b] * lengths[node] * lengths[node] / inertia_diagonal_[node];
      }
    });
  }
}

/// Sets θ_Tq in proportion to 1/c², with c_Tq the trace of the inertia that q would receive relative to D, with the
/// weights L².
void CellwiseBuilder::update_parts(const ContactCell& contact_cell, std::size_t end, bool first) {
  double sum = 0.0, least = 0.0;
  for (std::size_t s = contact_cell.first_share; s < end; ++s) {
    Share& share = shares_[s];
    const AffineInertia& costs = donors_[std::size_t(share.donor)].cost;
    share.cost = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) share.cost += share.inertia[a][b] * costs[a][b];
    }
    least = s == contact_cell.first_share ? share.cost : std::min(least, share.cost);
  }
  const auto relative_weight = [&](std::size_t s) { return (least / shares_[s].cost) * (least / shares_[s].cost); };
  for (std::size_t s = contact_cell.first_share; s < end; ++s) sum += relative_weight(s);
  for (std::size_t s = contact_cell.first_share; s < end; ++s) {
    const double part = relative_weight(s) / sum;
    shares_[s].part = first ? part : 0.5 * (shares_[s].part + part);
  }
}

void CellwiseBuilder::receive(const ContactCell& contact_cell, std::size_t end, double weight) {
  for (std::size_t s = contact_cell.first_share; s < end; ++s) {
    add_inertia(donors_[std::size_t(shares_[s].donor)].received, weight * shares_[s].part, shares_[s].inertia);
  }
}

/// Diagonal of the inertia after redistribution.
Vector CellwiseBuilder::diagonal() const {
  Vector result = retained_diagonal_;
  for (const Donor& donor : donors_) {
    for_each_weight(
        donor, [&](int node, const double* weight) { result[node] += quadratic_form(donor.received, weight, weight); });
  }
  return result;
}

/// Iterates on the shares with L = 1 at first, then M₀_ii/D_i. The shares are those of the inertia even if the mass
/// being built is damping, so that damping with a uniform rate equals that rate times the mass.
void CellwiseBuilder::share_out() {
  Vector lengths = Vector::Ones(inertia_diagonal_.size());
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    if (sweep > 0) lengths = diagonal().cwiseQuotient(inertia_diagonal_);
    update_costs(lengths);
    for (Donor& donor : donors_) donor.received = {};
    for (std::size_t g = 0; g < contact_cells_.size(); ++g) {
      const std::size_t end = g + 1 < contact_cells_.size() ? contact_cells_[g + 1].first_share : shares_.size();
      update_parts(contact_cells_[g], end, sweep == 0);
      receive(contact_cells_[g], end, sweep < sweeps ? 1.0 : contact_cells_[g].weight);
    }
  }
}

void CellwiseBuilder::hand_over() {
  for (const Donor& donor : donors_) {
    for_each_weight(donor, [&](int i, const double* left) {
      for_each_weight(donor, [&](int j, const double* right) {
        if (j < i) return;
        const double value = quadratic_form(donor.received, left, right);
        entry_of(result_, i, j) += value;
        if (j != i) entry_of(result_, j, i) += value;
      });
    });
  }
}

/// Throws an error that describes the massive nodes of the cell's body.
void CellwiseBuilder::refuse(const ContactCell& contact_cell) {
  rings_.start(contact_cell.cell);
  while (rings_.grow()) continue;
  const std::vector<Index> body = rings_.nodes();
  std::vector<Index> massive;
  std::ranges::copy_if(body, std::back_inserter(massive), [this](Index n) { return !is_contact(n); });
  const int* const nodes = rings_.nodes(contact_cell.cell);
  const Index node =
      *std::find_if(nodes, nodes + rings_.node_count(contact_cell.cell), [this](Index n) { return is_contact(n); });
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("mass type \"equivalent-cellwise\": the inertia of the contact node at {} cannot be moved to other "
                  "cells: its body has {}, and none of the nearest {} cells has {} of them that are not all {}; refine "
                  "the mesh there or set mesh.degree = 2, name only facets that may touch in the contact group, or use "
                  "mass type \"equivalent-nodewise\", which needs no whole cell (\"consistent\" and \"lumped\", with "
                  "scheme \"contact-stabilized\" or \"newmark\", have no such requirement)",
                  text_of_point(*input_.nodes, node), describe_massive_nodes(*input_.nodes, body, massive),
                  CellRings::many_cells, d_ + 1, d_ == 3 ? "in one plane" : "on one line"));
}

SparseMatrix build_cellwise_equivalent_mass(const MassInput& input, const Parameters&) {
  input.require_cells("equivalent-cellwise");
  SparseMatrix result = CellwiseBuilder(input).build();
  check_moments(input, result, "equivalent-cellwise");
  return result;
}

}  // namespace

MassRegistration cellwise_equivalent_mass() {
  return {"equivalent-cellwise", {.build = build_cellwise_equivalent_mass, .removes_contact_inertia = true}};
}

}  // namespace ricochet
