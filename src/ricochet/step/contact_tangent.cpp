#include "ricochet/step/contact_tangent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {

/// Width of differences, relative to the size of the model.
constexpr double width_of_differences = 1e-6;
/// Largest derivative of a gap by a displacement, beyond which it jumps.
constexpr double most_steep = 100.0;

using TangentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 2, 1>;
using TangentMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 2, 2>;

/// Calls visit(dof, value) for the entries of all rows of a point.
template <class Visit>
void visit_point(const ContactRows& rows, Index point, const Visit& visit) {
  rows.visit_normal(point, visit);
  const Index tangents = rows.dimension() - 1;
  for (Index row = point * tangents; row < (point + 1) * tangents; ++row) rows.visit_tangential(row, visit);
}

/// Adds the rows of a point to those of G and B_T.
void add_rows(const ContactRows& rows, Index point, std::vector<Eigen::Triplet<double>>& normal,
              std::vector<Eigen::Triplet<double>>& tangential) {
  const auto enter = [](Index row, std::vector<Eigen::Triplet<double>>& to) {
    return [row, &to](Index dof, double value) { to.emplace_back(int(row), int(dof), value); };
  };
  const Index tangents = rows.dimension() - 1;
  rows.visit_normal(point, enter(point, normal));
  for (Index row = point * tangents; row < (point + 1) * tangents; ++row)
    rows.visit_tangential(row, enter(row, tangential));
}

void assemble(const std::vector<Eigen::Triplet<double>>& entries, Index rows, Index columns, auto& matrix) {
  matrix.resize(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace

void ContactTangent::store_rows(const ContactRows& rows, Index dofs) {
  const Index tangents = rows.dimension() - 1;
  Triplets normal, tangential;
  for (Index i = 0; i < rows.size(); ++i) add_rows(rows, i, normal, tangential);
  assemble(normal, rows.size(), dofs, normal_rows_);
  assemble(tangential, rows.size() * tangents, dofs, tangential_rows_);
}

/// Colours the dofs greedily: those of a group belong to different points.
void ContactTangent::find_groups(const SemidiscreteProblem& problem, const ContactRows& rows) {
  const auto points = std::size_t(rows.size());
  dofs_of_.assign(points, {});
  std::vector<std::vector<std::size_t>> points_of(std::size_t(problem.dof_count()));
  for (std::size_t i = 0; i < points; ++i) {
    std::vector<Index>& dofs = dofs_of_[i];
    visit_point(rows, Index(i), [&](Index dof, double) { dofs.push_back(dof); });
    std::ranges::sort(dofs);
    dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
    for (const Index dof : dofs) points_of[std::size_t(dof)].push_back(i);
  }
  groups_.clear();
  std::vector<std::vector<char>> is_taken;  // per group and point
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    const std::vector<std::size_t>& of = points_of[std::size_t(dof)];
    if (of.empty()) continue;
    const auto is_free = [&](const std::vector<char>& taken) {
      return std::ranges::none_of(of, [&](std::size_t point) { return taken[point] != 0; });
    };
    const auto group = std::size_t(std::ranges::find_if(is_taken, is_free) - is_taken.begin());
    if (group == is_taken.size()) {
      is_taken.emplace_back(points, 0);
      groups_.emplace_back();
    }
    for (const std::size_t point : of) is_taken[group][point] = 1;
    groups_[group].push_back(dof);
  }
}

/// Adds the differences between both perturbed rows; `column_of`: the perturbed dof of each point, or −1. Tangents of a
/// perturbed normal may be rotated in their plane: components are converted to the present ones.
void ContactTangent::add_differences(const ContactRows& rows, const Reactions& reactions,
                                     const std::vector<int>& column_of, double width) {
  const double per_width = 1.0 / (2.0 * width);
  const Index tangents = rows.dimension() - 1;
  const auto turn = [&](const ContactRows& perturbed, std::size_t point) -> TangentMatrix {
    return perturbed.tangents[point].transpose() * rows.tangents[point];
  };
  const auto slip_of = [&](const ContactRows& perturbed, const Vector& slip, std::size_t point) -> TangentVector {
    return turn(perturbed, point).transpose() * slip.segment(Index(point) * tangents, tangents);
  };
  const auto add_force = [&](const ContactRows& perturbed, Index point, int column, double sign) {
    const auto enter = [&](double force) {
      return [&, force](Index dof, double value) { force_entries_.emplace_back(int(dof), column, force * value); };
    };
    const double normal = sign * per_width * reactions.normal_reaction[point];
    if (normal != 0.0) perturbed.visit_normal(point, enter(normal));
    if (reactions.tangential_reaction.size() == 0) return;
    const TangentVector along = (-sign * per_width) * turn(perturbed, std::size_t(point)) *
                                reactions.tangential_reaction.segment(point * tangents, tangents);
    for (Index k = 0; k < tangents; ++k)
      if (along[k] != 0.0) perturbed.visit_tangential(point * tangents + k, enter(along[k]));
  };
  for (std::size_t i = 0; i < column_of.size(); ++i) {
    const int column = column_of[i];
    if (column < 0) continue;
    const auto point = Index(i);
    const double slope = per_width * (forward_.gap[point] - backward_.gap[point]);
    if (!(std::abs(slope) <= most_steep)) keeps_rows_[i] = 1;
    if (keeps_rows_[i] != 0) continue;
    gap_entries_.emplace_back(int(i), column, slope);
    const TangentVector slip = slip_of(forward_, forward_slip_, i) - slip_of(backward_, backward_slip_, i);
    for (Index k = 0; k < tangents; ++k)
      slip_entries_.emplace_back(int(point * tangents + k), column, per_width * slip[k]);
    add_force(forward_, point, column, 1.0);
    add_force(backward_, point, column, -1.0);
  }
}

void ContactTangent::add_kept_rows(const ContactRows& rows) {
  const Index tangents = rows.dimension() - 1;
  std::erase_if(gap_entries_, [&](const auto& entry) { return keeps_rows_[std::size_t(entry.row())] != 0; });
  std::erase_if(slip_entries_,
                [&](const auto& entry) { return keeps_rows_[std::size_t(entry.row() / tangents)] != 0; });
  for (Index i = 0; i < rows.size(); ++i) {
    if (keeps_rows_[std::size_t(i)] != 0) add_rows(rows, i, gap_entries_, slip_entries_);
  }
}

/// Marks the points at which contact does not follow the motion: the geometry leaves their gaps alone.
void ContactTangent::find_constant_rows(const ContactGeometry& geometry, const ContactPlace& place, Index points) {
  gap_probe_.setConstant(points, std::numeric_limits<double>::quiet_NaN());
  geometry.gaps(place.end, place.time, gap_probe_);
  keeps_rows_.resize(std::size_t(points));
  for (Index i = 0; i < points; ++i) keeps_rows_[std::size_t(i)] = std::isnan(gap_probe_[i]) ? 1 : 0;
}

void ContactTangent::differentiate(const SemidiscreteProblem& problem, const ContactPlace& place,
                                   const ContactRows& rows, const Reactions& reactions) {
  const Index dofs = problem.dof_count();
  store_rows(rows, dofs);
  if (!problem.contact.follows_motion()) {
    gap_ = normal_rows_;
    slip_ = tangential_rows_;
    force_.resize(dofs, dofs);
    return;
  }
  const ContactGeometry& geometry = *problem.contact.geometry;
  const double width = width_of_differences * extent(problem.nodes);
  find_groups(problem, rows);
  gap_entries_.clear();
  slip_entries_.clear();
  force_entries_.clear();
  find_constant_rows(geometry, place, rows.size());
  forward_ = backward_ = rows;
  perturbed_ = place.end;
  std::vector<int> column_of(std::size_t(rows.size()));
  const auto evaluate = [&](const std::vector<Index>& group, double way, ContactRows& result, Vector& slip) {
    for (const Index dof : group) perturbed_[dof] = place.end[dof] + way;
    geometry.update(perturbed_, place.time, place.rows_from, result);
    increment_ = perturbed_ - place.start;
    result.tangential_motion(increment_, slip);
    for (const Index dof : group) perturbed_[dof] = place.end[dof];
  };
  for (const std::vector<Index>& group : groups_) {
    evaluate(group, width, forward_, forward_slip_);
    evaluate(group, -width, backward_, backward_slip_);
    for (std::size_t i = 0; i < column_of.size(); ++i) {
      const auto sees = [&](Index dof) { return std::ranges::binary_search(dofs_of_[i], dof); };
      const auto found = std::ranges::find_if(group, sees);
      column_of[i] = found != group.end() ? int(*found) : -1;
    }
    add_differences(rows, reactions, column_of, width);
  }
  add_kept_rows(rows);
  geometry.update(place.end, place.time, place.rows_from, forward_);  // what the geometry remembers is that of the end
  assemble(gap_entries_, rows.size(), dofs, gap_);
  assemble(slip_entries_, rows.size() * (rows.dimension() - 1), dofs, slip_);
  assemble(force_entries_, dofs, dofs, force_);
}

}  // namespace ricochet
