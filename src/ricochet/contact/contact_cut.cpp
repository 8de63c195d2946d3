#include "ricochet/contact/contact_cut.hpp"

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/selection.hpp"

namespace ricochet {

namespace {

/// Extracts rows of a matrix, in this order, with its columns renumbered: those with number −1 are omitted.
SparseRowMatrix cut_matrix(const SparseRowMatrix& whole, const std::vector<Index>& rows, Index columns,
                           const std::function<Index(Index)>& new_column) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (SparseRowMatrix::InnerIterator entry(whole, rows[i]); entry; ++entry) {
      const Index at = new_column(entry.col());
      if (at >= 0) entries.emplace_back(static_cast<int>(i), static_cast<int>(at), entry.value());
    }
  }
  SparseRowMatrix result(static_cast<Index>(rows.size()), columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Returns the `per` rows of each point.
std::vector<Index> rows_of(const std::vector<Index>& points, Index per) {
  std::vector<Index> result;
  for (const Index point : points) {
    for (Index k = 0; k < per; ++k) result.push_back(point * per + k);
  }
  return result;
}

}  // namespace

SparseRowMatrix cut_trace(const SparseRowMatrix& whole, const ContactCut& part) {
  return cut_matrix(whole, part.points, part.nodes,
                    [&](Index node) { return part.node_number[static_cast<std::size_t>(node)]; });
}

namespace {

ContactRows cut_rows(const ContactRows& whole, const ContactCut& part) {
  const Index d = whole.dimension();
  const auto number_of_dof = [&](Index dof) {
    const Index node = part.node_number[static_cast<std::size_t>(dof / d)];
    return node < 0 ? -1 : node * d + dof % d;
  };
  const std::vector<Index> slip_rows = rows_of(part.points, d - 1);
  ContactRows rows;
  rows.normals = chosen_columns(whole.normals, part.points);
  rows.tangents = chosen(whole.tangents, part.points);
  rows.slips = chosen(whole.slips, slip_rows);
  rows.gap_rounding = chosen(whole.gap_rounding, part.points);
  rows.gap_operator = cut_matrix(whole.gap_operator, part.points, part.nodes * d, number_of_dof);
  rows.tangential_trace = cut_matrix(whole.tangential_trace, slip_rows, part.nodes * d, number_of_dof);
  if (whole.gap.size() > 0) rows.gap = chosen(whole.gap, part.points);
  rows.revision = chosen(whole.revision, part.points);
  if (whole.rotating_trace)
    rows.rotating_trace = std::make_shared<const SparseRowMatrix>(cut_trace(*whole.rotating_trace, part));
  return rows;
}

}  // namespace

ContactBoundary cut_contact(const ContactBoundary& whole, const ContactCut& part) {
  if (whole.net.size() > 0 && whole.net.minCoeff() == 0.0)
    throw Error(ErrorKind::invalid_input, "contact between bodies cannot be divided");
  const auto number_of_node = [&](Index node) { return part.node_number[static_cast<std::size_t>(node)]; };
  const std::vector<Index> point_index = inverse_indices(part.points, whole.size());
  ContactBoundary own;
  own.dimension = whole.dimension;
  for (const Index facet : whole.facets) {
    const Index number = part.facet_number.empty() ? -1 : part.facet_number[static_cast<std::size_t>(facet)];
    if (number >= 0) own.facets.push_back(number);
  }
  std::sort(own.facets.begin(), own.facets.end());
  own.pair = chosen(whole.pair, part.points);
  own.initial_gap = chosen(whole.initial_gap, part.points);
  own.weights = chosen(whole.weights, part.points);
  own.friction_coefficient = chosen(whole.friction_coefficient, part.points);
  own.friction_bound = chosen(whole.friction_bound, part.points);
  own.has_friction_elsewhere = whole.has_friction();
  own.trace = cut_trace(whole.trace, part);
  own.own_trace = cut_trace(whole.own_trace, part);
  own.net = chosen(whole.net, part.points);
  own.large_sliding = chosen(whole.large_sliding, part.points);
  own.opposite_node = whole.opposite_node;
  for (const Index entry : part.entries) {
    const auto at = static_cast<std::size_t>(entry);
    own.nodes.push_back(number_of_node(whole.nodes[at]));
    const Index point = whole.own_point[at];
    const Index number = point < 0 ? -1 : point_index[static_cast<std::size_t>(point)];
    own.own_point.push_back(point >= 0 && number < 0 ? -2 : number);
  }
  own.node_pair = chosen(whole.node_pair, part.entries);
  own.is_opposite = chosen(whole.is_opposite, part.entries);
  own.node_normals = chosen_columns(whole.node_normals, part.entries);
  own.node_initial_gap = chosen(whole.node_initial_gap, part.entries);
  own.opposite_projection.resize(0, 0);
  own.pressure_recovery = cut_matrix(whole.pressure_recovery, part.entries, static_cast<Index>(part.points.size()),
                                     [&](Index point) { return point_index[static_cast<std::size_t>(point)]; });
  own.rows = std::make_shared<const ContactRows>(cut_rows(*whole.rows, part));
  if (whole.follows_motion()) {
    own.geometry = whole.geometry->cut(part);
    if (own.geometry == nullptr)
      throw Error(ErrorKind::invalid_input, "contact whose directions rotate with bodies cannot be divided");
  }
  return own;
}

}  // namespace ricochet
