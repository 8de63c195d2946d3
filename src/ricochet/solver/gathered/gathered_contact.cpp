#include "ricochet/solver/gathered/gathered_contact.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "ricochet/solver/gathered/number_reader.hpp"

namespace ricochet {

namespace {

/// Body of which only the positions of the nodes are used.
class NoForce final : public InternalForce {
 public:
  void evaluate(const Vector&, Vector&) const override { refuse(); }
  [[nodiscard]] double energy(const Vector&) const override { refuse(); }
  void strain_force(const Vector&, const Vector&, Vector&) const override { refuse(); }
  [[nodiscard]] bool is_linear() const override { return true; }
  [[nodiscard]] SparseMatrix tangent(const Vector&) const override { refuse(); }

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("gathered contact has no internal forces"); }
};

void append_row(const SparseRowMatrix& matrix, Index row, Index per_node, const Ranks& ranks,
                std::vector<double>& message) {
  const auto* const outer = matrix.outerIndexPtr();
  message.push_back(static_cast<double>(outer[row + 1] - outer[row]));
  for (SparseRowMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
    const Index node = entry.col() / per_node;
    message.push_back(static_cast<double>(ranks.number_of(node) * per_node + entry.col() % per_node));
    message.push_back(entry.value());
  }
}

using Triplets = std::vector<Eigen::Triplet<double>>;

void read_row(NumberReader& message, Index row, Index per_node, const GatheredNodes& nodes, Triplets& entries) {
  for (Index count = message.integer(); count > 0; --count) {
    const Index dof = message.integer();
    const Index column = nodes.index_of(dof / per_node) * per_node + dof % per_node;
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), message.next());
  }
}

void copy_row(const SparseRowMatrix& matrix, Index row, Triplets& entries) {
  for (SparseRowMatrix::InnerIterator entry(matrix, row); entry; ++entry)
    entries.emplace_back(static_cast<int>(row), static_cast<int>(entry.col()), entry.value());
}

/// Appends all row data of a point.
void append_point(const ContactRows& rows, Index point, Index d, const Ranks& ranks, std::vector<double>& message) {
  const auto append = [&message](const auto& values) {
    message.insert(message.end(), values.data(), values.data() + values.size());
  };
  message.push_back(static_cast<double>(point));
  append(rows.normals.col(point));
  append(rows.tangents[static_cast<std::size_t>(point)]);
  for (Index row = point * (d - 1); row < (point + 1) * (d - 1); ++row)
    message.push_back(rows.slips[static_cast<std::size_t>(row)]);
  message.push_back(rows.gap_rounding[point]);
  append_row(rows.gap_operator, point, d, ranks, message);
  for (Index row = point * (d - 1); row < (point + 1) * (d - 1); ++row)
    append_row(rows.tangential_trace, row, d, ranks, message);
}

SparseRowMatrix matrix_of(const Triplets& entries, Index rows, Index columns) {
  SparseRowMatrix result(rows, columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

SparseRowMatrix with_columns(SparseRowMatrix matrix, Index columns) {
  matrix.conservativeResize(matrix.rows(), columns);
  return matrix;
}

}  // namespace

GatheredContact::GatheredContact(const SemidiscreteProblem& problem, std::size_t root_index)
    : problem_(problem), d_(problem.dimension) {
  const Ranks& ranks = *problem.ranks;
  const auto size = static_cast<std::size_t>(ranks.size());
  Ranks::ForEach<std::int64_t> sent(size, {static_cast<std::int64_t>(problem.contact.size())});
  first_.assign(1, 0);
  const Ranks::ForEach<std::int64_t> counts = ranks.exchange(std::move(sent));
  for (const std::vector<std::int64_t>& count : counts) first_.push_back(first_.back() + count.front());
  std::vector<int> by_points(size);
  std::iota(by_points.begin(), by_points.end(), 0);
  std::stable_sort(by_points.begin(), by_points.end(), [&](int a, int b) {
    return counts[static_cast<std::size_t>(a)].front() > counts[static_cast<std::size_t>(b)].front();
  });
  nodes_ = GatheredNodes(ranks, by_points.at(root_index), named_by_all(problem.contact.unique_nodes()));
  gather_boundary();
}

std::vector<Index> GatheredContact::named_by_all(const std::vector<Index>& nodes) const {
  Vector named = Vector::Zero(problem_.nodes.cols());
  for (const Index node : nodes) named[node] = 1.0;
  problem_.ranks->accumulate(named);
  std::vector<Index> result;
  for (Index node = 0; node < named.size(); ++node) {
    if (named[node] > 0.0) result.push_back(node);
  }
  return result;
}

/// Gathers everything except the rows, and allocates these.
void GatheredContact::gather_boundary() {
  const Ranks& ranks = *problem_.ranks;
  const ContactBoundary& own = problem_.contact;
  Ranks::ForEach<double> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<double>& message = sent[static_cast<std::size_t>(nodes_.root())];
  for (Index point = 0; point < own.size(); ++point) {
    message.insert(message.end(), {static_cast<double>(own.pair[static_cast<std::size_t>(point)]), own.weights[point],
                                   own.friction_coefficient[point], own.friction_bound[point], own.net[point]});
    append_row(own.trace, point, 1, ranks, message);
    append_row(own.own_trace, point, 1, ranks, message);
  }
  received_ = ranks.exchange(std::move(sent));
  Vector solved = Vector::Zero(problem_.dof_count());
  for (const Index dof : problem_.contact_dofs) solved[dof] = 1.0;
  const Vector is_solved = nodes_.gather(solved, d_);
  if (is_root()) {
    read_boundary();
    for (Index dof = 0; dof < is_solved.size(); ++dof) {
      if (is_solved[dof] > 0.0) contact_dofs_.push_back(dof);
    }
    rows_ = empty_rows();
  }
  gather_rows(*own.rows);
}

void GatheredContact::read_boundary() {
  const Index points = point_count();
  boundary_.dimension = d_;
  boundary_.pair.resize(static_cast<std::size_t>(points));
  const std::array<Vector*, 4> per_point{&boundary_.weights, &boundary_.friction_coefficient, &boundary_.friction_bound,
                                         &boundary_.net};
  for (Vector* const values : per_point) values->setZero(points);
  boundary_.initial_gap.setZero(points);
  Triplets trace, own_trace;
  Index point = 0;
  for (const std::vector<double>& from : received_) {
    for (NumberReader numbers(from); !numbers.is_at_end(); ++point) {
      boundary_.pair[static_cast<std::size_t>(point)] = static_cast<int>(numbers.integer());
      for (Vector* const values : per_point) (*values)[point] = numbers.next();
      read_row(numbers, point, 1, nodes_, trace);
      read_row(numbers, point, 1, nodes_, own_trace);
    }
  }
  boundary_.trace = matrix_of(trace, points, nodes_.count());
  boundary_.own_trace = matrix_of(own_trace, points, nodes_.count());
}

std::shared_ptr<ContactRows> GatheredContact::empty_rows() const {
  const Index points = point_count();
  auto rows = std::make_shared<ContactRows>();
  rows->normals.setZero(d_, points);
  rows->tangents.assign(static_cast<std::size_t>(points), Points::Zero(d_, d_ - 1));
  rows->slips.assign(static_cast<std::size_t>(points * (d_ - 1)), 0);
  rows->gap_rounding.setZero(points);
  rows->gap_operator.resize(points, nodes_.count() * d_);
  rows->tangential_trace.resize(points * (d_ - 1), nodes_.count() * d_);
  if (problem_.contact.follows_motion()) rows->revision.assign(static_cast<std::size_t>(points), 0);
  return rows;
}

/// Gathers the changed rows.
void GatheredContact::gather_rows(const ContactRows& rows) {
  const Ranks& ranks = *problem_.ranks;
  const bool is_first = changes_++ == 0;
  std::vector<Index> changed;
  for (Index point = 0; point < rows.size(); ++point) {
    const auto at = static_cast<std::size_t>(point);
    if (is_first || rows.revision[at] != revision_[at]) changed.push_back(point);
  }
  revision_ = rows.revision;
  if (!ranks.any(!changed.empty())) return;
  Ranks::ForEach<double> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<double>& message = sent[static_cast<std::size_t>(nodes_.root())];
  for (const Index point : changed) append_point(rows, point, d_, ranks, message);
  received_ = ranks.exchange(std::move(sent));
  if (is_root()) rows_ = read_rows();
}

/// Merges the received rows with the unchanged ones, in new storage: others may keep those of earlier stages.
std::shared_ptr<ContactRows> GatheredContact::read_rows() const {
  auto rows = std::make_shared<ContactRows>(*rows_);
  std::vector<char> is_new(static_cast<std::size_t>(point_count()), 0);
  Triplets gap, slip;
  const auto slip_rows = [this](Index point, const auto& visit) {
    for (Index row = point * (d_ - 1); row < (point + 1) * (d_ - 1); ++row) visit(row);
  };
  for (std::size_t rank = 0; rank < received_.size(); ++rank) {
    for (NumberReader numbers(received_[rank]); !numbers.is_at_end();) {
      const Index point = number(static_cast<int>(rank), numbers.integer());
      const auto at = static_cast<std::size_t>(point);
      is_new[at] = 1;
      numbers.fill(rows->normals.col(point));
      numbers.fill(rows->tangents[at]);
      slip_rows(point, [&](Index row) { rows->slips[static_cast<std::size_t>(row)] = numbers.next() != 0.0 ? 1 : 0; });
      rows->gap_rounding[point] = numbers.next();
      if (!rows->revision.empty()) rows->revision[at] = changes_;
      read_row(numbers, point, d_, nodes_, gap);
      slip_rows(point, [&](Index row) { read_row(numbers, row, d_, nodes_, slip); });
    }
  }
  for (Index point = 0; point < point_count(); ++point) {
    if (is_new[static_cast<std::size_t>(point)] != 0) continue;
    copy_row(rows_->gap_operator, point, gap);
    slip_rows(point, [&](Index row) { copy_row(rows_->tangential_trace, row, slip); });
  }
  rows->gap_operator = matrix_of(gap, point_count(), nodes_.count() * d_);
  rows->tangential_trace = matrix_of(slip, point_count() * (d_ - 1), nodes_.count() * d_);
  return rows;
}

std::shared_ptr<const ContactRows> GatheredContact::rows_on(const ContactRows& rows, Index dofs) {
  auto result = std::make_shared<ContactRows>(rows);
  result->gap_operator = with_columns(std::move(result->gap_operator), dofs);
  result->tangential_trace = with_columns(std::move(result->tangential_trace), dofs);
  return result;
}

std::unique_ptr<SemidiscreteProblem> GatheredContact::make_problem(const GatheredNodes& nodes) const {
  const Vector positions = nodes.gather(problem_.nodes.reshaped(), d_);
  const Vector of_contact = nodes_.gather(problem_.nodes.reshaped(), d_);
  if (!is_root()) return nullptr;
  auto result = std::make_unique<SemidiscreteProblem>();
  result->dimension = d_;
  result->axisymmetric = problem_.axisymmetric;
  result->nodes = positions.reshaped(d_, nodes.count());
  result->nodes.leftCols(nodes_.count()) = of_contact.reshaped(d_, nodes_.count());
  result->internal_force = std::make_shared<NoForce>();
  result->contact = boundary_;
  result->contact.trace = with_columns(boundary_.trace, nodes.count());
  result->contact.own_trace = with_columns(boundary_.own_trace, nodes.count());
  result->contact.rows = rows_on(*rows_, result->dof_count());
  result->contact_dofs = contact_dofs_;
  result->obstacles = problem_.obstacles;
  result->is_massless.assign(static_cast<std::size_t>(result->dof_count()), 0);
  return result;
}

}  // namespace ricochet
