#include "ricochet/distributed/cut_problem.hpp"

#include "ricochet/base/selection.hpp"
#include "ricochet/contact/contact_cut.hpp"

namespace ricochet {

namespace {

ContactCut contact_part(const SemidiscreteProblem& global, const Division& division, const Piece& piece, int rank) {
  ContactCut part;
  part.points = division.points_of(rank);
  part.node_number = inverse_indices(piece.node_number, global.nodes.cols());
  part.nodes = Index(piece.node_number.size());
  for (std::size_t entry = 0; entry < global.contact.nodes.size(); ++entry) {
    if (part.node_number[std::size_t(global.contact.nodes[entry])] >= 0) part.entries.push_back(Index(entry));
  }
  const Index facets = global.contact.facets.empty() ? 0 : global.contact.facets.back() + 1;
  part.facet_number.assign(std::size_t(facets), -1);
  for (std::size_t i = 0; i < piece.facet_number.size() && piece.facet_number[i] < facets; ++i)
    part.facet_number[std::size_t(piece.facet_number[i])] = Index(i);
  return part;
}

}  // namespace

Vector cut_values(const Vector& global, const Piece& piece, int per_node) {
  Vector result(static_cast<Index>(piece.node_number.size()) * per_node);
  for (std::size_t i = 0; i < piece.node_number.size(); ++i)
    result.segment(Index(i) * per_node, per_node) = global.segment(piece.node_number[i] * per_node, per_node);
  return result;
}

SparseMatrix cut_matrix(const NodeMatrix& global, const Division& division, const Piece& piece, int rank) {
  SparseMatrix result = global.principal(piece.node_number);
  const int d = global.dimension();
  const auto node = [&](Index dof) { return piece.node_number[std::size_t(dof / d)]; };
  result.prune([&](Index row, Index column, double) { return division.rank_of_pair(node(row), node(column)) == rank; });
  return result;
}

SemidiscreteProblem cut_problem(const SemidiscreteProblem& global, const Division& division, const Piece& piece,
                                int rank) {
  const int d = global.dimension;
  SemidiscreteProblem own;
  own.dimension = d;
  own.axisymmetric = global.axisymmetric;
  own.nodes = piece.space.nodes;
  own.mass = NodeMatrix(cut_matrix(global.mass, division, piece, rank), d);
  own.contact = cut_contact(global.contact, contact_part(global, division, piece, rank));
  own.obstacles = global.obstacles;
  own.is_massless.resize(piece.node_number.size() * std::size_t(d));
  std::vector<char> is_contact(static_cast<std::size_t>(global.dof_count()), 0);
  for (const Index dof : global.contact_dofs) is_contact[std::size_t(dof)] = 1;
  for (std::size_t i = 0; i < piece.node_number.size(); ++i) {
    for (int k = 0; k < d; ++k) {
      const Index from = piece.node_number[i] * d + k, to = Index(i) * d + k;
      const auto at = std::size_t(from);
      if (global.supports.contains(from)) own.supports.add(to, global.supports.expression(from));
      if (is_contact[at] != 0) own.contact_dofs.push_back(to);
      own.is_massless[std::size_t(to)] = global.is_massless[at];
      if (global.is_massless[at] != 0) own.massless_dofs.push_back(to);
    }
  }
  own.supports.finish();
  own.has_massless_elsewhere = global.has_singular_mass();
  own.has_contact_elsewhere = global.has_contact_dofs();
  return own;
}

}  // namespace ricochet
