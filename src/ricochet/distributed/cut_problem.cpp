#include "ricochet/distributed/cut_problem.hpp"

#include "ricochet/base/selection.hpp"
#include "ricochet/contact/contact_cut.hpp"

namespace ricochet {

namespace {

ContactCut contact_part(const SemidiscreteProblem& whole, const Division& division, const Piece& piece, int rank) {
  ContactCut part;
  part.points = division.points_of(rank);
  part.node_number = inverse_indices(piece.node_number, whole.nodes.cols());
  part.nodes = static_cast<Index>(piece.node_number.size());
  for (std::size_t entry = 0; entry < whole.contact.nodes.size(); ++entry) {
    if (part.node_number[static_cast<std::size_t>(whole.contact.nodes[entry])] >= 0)
      part.entries.push_back(static_cast<Index>(entry));
  }
  const Index facets = whole.contact.facets.empty() ? 0 : whole.contact.facets.back() + 1;
  part.facet_number.assign(static_cast<std::size_t>(facets), -1);
  for (std::size_t i = 0; i < piece.facet_number.size() && piece.facet_number[i] < facets; ++i)
    part.facet_number[static_cast<std::size_t>(piece.facet_number[i])] = static_cast<Index>(i);
  return part;
}

}  // namespace

Vector cut_values(const Vector& whole, const Piece& piece, int per_node) {
  Vector result(static_cast<Index>(piece.node_number.size()) * per_node);
  for (std::size_t i = 0; i < piece.node_number.size(); ++i)
    result.segment(static_cast<Index>(i) * per_node, per_node) =
        whole.segment(piece.node_number[i] * per_node, per_node);
  return result;
}

SparseMatrix cut_matrix(const NodeMatrix& whole, const Division& division, const Piece& piece, int rank) {
  SparseMatrix result = whole.principal(piece.node_number);
  const int d = whole.dimension();
  const auto node = [&](Index dof) { return piece.node_number[static_cast<std::size_t>(dof / d)]; };
  result.prune([&](Index row, Index column, double) { return division.rank_of_pair(node(row), node(column)) == rank; });
  return result;
}

SemidiscreteProblem cut_problem(const SemidiscreteProblem& whole, const Division& division, const Piece& piece,
                                int rank) {
  const int d = whole.dimension;
  SemidiscreteProblem own;
  own.dimension = d;
  own.axisymmetric = whole.axisymmetric;
  own.nodes = piece.space.nodes;
  own.mass = NodeMatrix(cut_matrix(whole.mass, division, piece, rank), d);
  own.contact = cut_contact(whole.contact, contact_part(whole, division, piece, rank));
  own.obstacles = whole.obstacles;
  own.is_massless.resize(piece.node_number.size() * static_cast<std::size_t>(d));
  std::vector<char> is_contact(static_cast<std::size_t>(whole.dof_count()), 0);
  for (const Index dof : whole.contact_dofs) is_contact[static_cast<std::size_t>(dof)] = 1;
  for (std::size_t i = 0; i < piece.node_number.size(); ++i) {
    for (int k = 0; k < d; ++k) {
      const Index from = piece.node_number[i] * d + k, to = static_cast<Index>(i) * d + k;
      const auto at = static_cast<std::size_t>(from);
      if (whole.supports.contains(from)) own.supports.add(to, whole.supports.expression(from));
      if (is_contact[at] != 0) own.contact_dofs.push_back(to);
      own.is_massless[static_cast<std::size_t>(to)] = whole.is_massless[at];
      if (whole.is_massless[at] != 0) own.massless_dofs.push_back(to);
    }
  }
  own.supports.finish();
  own.has_massless_elsewhere = whole.has_singular_mass();
  own.has_contact_elsewhere = whole.has_contact_dofs();
  return own;
}

}  // namespace ricochet
