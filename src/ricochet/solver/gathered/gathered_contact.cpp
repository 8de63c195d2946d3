#include "ricochet/solver/gathered/gathered_contact.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "ricochet/solver/gathered/point_messages.hpp"

namespace ricochet {

namespace {

/// Body of which only the positions of the nodes are used.
class NoForce final : public InternalForce {
 public:
  void evaluate(const Vector&, Vector&) const override { refuse(); }
  [[nodiscard]] double energy(const Vector&) const override { refuse(); }
  [[nodiscard]] bool is_linear() const override { return true; }
  [[nodiscard]] SparseMatrix tangent(const Vector&) const override { refuse(); }

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("gathered contact has no internal forces"); }
};

SparseRowMatrix with_columns(SparseRowMatrix matrix, Index columns) {
  matrix.conservativeResize(matrix.rows(), columns);
  return matrix;
}

/// Adds the reactions at the points of a part; all other points of the part are open.
void add_reactions(const StageSolution& part, StageSolution& solution) {
  solution.normal_reaction += part.normal_reaction;
  if (part.tangential_reaction.size() > 0) solution.tangential_reaction += part.tangential_reaction;
  if (part.mean_normal_reaction.size() > 0) solution.mean_normal_reaction = part.mean_normal_reaction;
  if (part.mean_tangential_reaction.size() > 0) solution.mean_tangential_reaction = part.mean_tangential_reaction;
  for (std::size_t i = 0; i < solution.contact_status.size(); ++i)
    solution.contact_status[i] = std::max(solution.contact_status[i], part.contact_status[i]);
}

}  // namespace

GatheredContact::GatheredContact(const SemidiscreteProblem& problem, std::size_t root_index)
    : problem_(problem), d_(problem.dimension) {
  const Ranks& ranks = *problem.ranks;
  const auto size = std::size_t(ranks.size());
  Ranks::ForEach<std::int64_t> sent(size, {std::int64_t(problem.contact.size())});
  first_.assign(1, 0);
  const Ranks::ForEach<std::int64_t> counts = ranks.exchange(std::move(sent));
  for (const std::vector<std::int64_t>& count : counts) first_.push_back(first_.back() + count.front());
  std::vector<int> by_points(size);
  std::iota(by_points.begin(), by_points.end(), 0);
  std::ranges::stable_sort(
      by_points, [&](int a, int b) { return counts[std::size_t(a)].front() > counts[std::size_t(b)].front(); });
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

template <class Values>
void GatheredContact::gather_values(const std::vector<Index>& points, const Values& values, bool keeps,
                                    Values& at_root) const {
  const Ranks& ranks = *problem_.ranks;
  Ranks::ForEach<double> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<double>& message = sent[std::size_t(nodes_.root())];
  message.push_back(double(points.size()));
  for (const Index point : points) message.push_back(double(point));
  PointWriter writer(ranks, d_, points, message);
  persist(writer, values);
  const Ranks::ForEach<double> received = ranks.exchange(std::move(sent));
  if (!is_root()) return;
  std::vector<PointReader::Part> parts;
  for (std::size_t rank = 0; rank < received.size(); ++rank) {
    NumberReader numbers(received[rank]);
    std::vector<Index> own(static_cast<std::size_t>(numbers.integer()));
    for (Index& point : own) point = number(int(rank), numbers.integer());
    parts.push_back({numbers, std::move(own)});
  }
  PointReader reader(d_, point_count(), nodes_, keeps, std::move(parts));
  persist(reader, at_root);
}

/// Gathers everything that the contact points have.
void GatheredContact::gather_boundary() {
  const ContactBoundary& own = problem_.contact;
  std::vector<Index> points(static_cast<std::size_t>(own.size()));
  std::iota(points.begin(), points.end(), 0);
  boundary_.dimension = d_;
  gather_values(points, own, false, boundary_);
  Vector solved = Vector::Zero(problem_.dof_count());
  for (const Index dof : problem_.contact_dofs) solved[dof] = 1.0;
  const Vector is_solved = nodes_.gather(solved, d_);
  for (Index dof = 0; dof < is_solved.size(); ++dof) {
    if (is_solved[dof] > 0.0) contact_dofs_.push_back(dof);
  }
  gather_rows(*own.rows);
}

/// Gathers the changed rows and merges them with the others in new storage: others may keep those of earlier stages.
void GatheredContact::gather_rows(const ContactRows& rows) {
  const bool is_first = changes_++ == 0;
  std::vector<Index> changed;
  for (Index point = 0; point < rows.size(); ++point) {
    const auto at = std::size_t(point);
    if (is_first || rows.revision[at] != revision_[at]) changed.push_back(point);
  }
  revision_ = rows.revision;
  if (!problem_.ranks->any(!changed.empty())) return;
  const auto merged = rows_ ? std::make_shared<ContactRows>(*rows_) : std::make_shared<ContactRows>();
  ContactRows sent = rows;
  std::ranges::fill(sent.revision, changes_);
  gather_values(changed, sent, true, *merged);
  rows_ = merged;
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
  result->is_massless.assign(std::size_t(result->dof_count()), 0);
  return result;
}

void GatheredContact::gather(const LinearStage& stage, const Vector& x, const std::vector<Index>& points,
                             Stage& at_root) {
  if (problem_.contact.follows_motion()) gather_rows(stage.rows);
  sent_stage_.conditions = stage.conditions;
  sent_stage_.start = stage.start;
  AffineMotion &gap = sent_stage_.conditions.gap, &slip = sent_stage_.conditions.slip;
  stage.rows.normal_motion(x, motion_);
  gap.offset += gap.factor * motion_;
  if (slip.offset.size() > 0) {
    stage.rows.tangential_motion(x, motion_);
    slip.offset += slip.factor * motion_;
  }
  gather_values(points, sent_stage_, false, at_root);
  at_root.conditions.gap.factor = gap.factor;
  at_root.conditions.slip.factor = slip.factor;
  at_root.right_hand_side.prescribed.resize(0);
  at_root.rows = rows_;
}

void GatheredContact::scatter(const StageSolution& at_root, const std::vector<Index>& points, StageSolution& solution) {
  const Ranks& ranks = *problem_.ranks;
  const auto size = std::size_t(ranks.size());
  Ranks::ForEach<std::int64_t> requested(size);
  requested[std::size_t(nodes_.root())].assign(points.begin(), points.end());
  const Ranks::ForEach<std::int64_t> requests = ranks.exchange(std::move(requested));
  Ranks::ForEach<double> sent(size);
  for (std::size_t rank = 0; is_root() && rank < size; ++rank) {
    std::vector<Index> of_rank;
    for (const std::int64_t point : requests[rank]) of_rank.push_back(number(int(rank), point));
    sent[rank] = {double(at_root.iterations), at_root.end_weight};
    PointWriter writer(ranks, d_, of_rank, sent[rank]);
    persist(writer, at_root);
  }
  const Ranks::ForEach<double> received = ranks.exchange(std::move(sent));
  NumberReader numbers(received[std::size_t(nodes_.root())]);
  solution.iterations += int(numbers.integer());
  solution.end_weight = numbers.next();
  PointReader reader(d_, problem_.contact.size(), nodes_, false, {{numbers, points}});
  persist(reader, received_solution_);
  add_reactions(received_solution_, solution);
  // The works of the ranks are summed.
  if (!is_root()) return;
  solution.path_contact_work = at_root.path_contact_work;
  solution.path_friction_work = at_root.path_friction_work;
}

}  // namespace ricochet
