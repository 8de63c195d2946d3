#include "ricochet/solver/gathered_contact.hpp"

#include <algorithm>
#include <stdexcept>

namespace ricochet {

namespace {

/// Numbers, one after the other.
class Reader {
 public:
  explicit Reader(const std::vector<double>& numbers) : at_(numbers.data()), end_(at_ + numbers.size()) {}
  [[nodiscard]] bool is_at_end() const { return at_ == end_; }
  double next() { return *at_++; }
  Index integer() { return static_cast<Index>(next()); }
  template <class Values>
  void fill(Values&& values) {
    for (Index i = 0; i < values.size(); ++i) values.data()[i] = next();
  }

 private:
  const double *at_, *end_;
};

/// A body at the nodes of which nothing is asked for but where they are.
class NoForce final : public InternalForce {
 public:
  void evaluate(const Vector&, Vector&) const override { refuse(); }
  [[nodiscard]] double energy(const Vector&) const override { refuse(); }
  void strain_force(const Vector&, const Vector&, Vector&) const override { refuse(); }
  [[nodiscard]] bool is_linear() const override { return true; }
  [[nodiscard]] SparseMatrix tangent(const Vector&) const override { refuse(); }

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("gathered contact has no forces of its own"); }
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

void read_row(Reader& message, Index row, Index per_node, const GatheredNodes& nodes, Triplets& entries) {
  for (Index count = message.integer(); count > 0; --count) {
    const Index dof = message.integer();
    const Index column = nodes.place_of(dof / per_node) * per_node + dof % per_node;
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), message.next());
  }
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

/// A number per point of some vector; 0 where it is not part of a stage.
double value_of(const Vector& values, Index i) {
  return values.size() > 0 ? values[i] : 0.0;
}

}  // namespace

GatheredContact::GatheredContact(const SemidiscreteProblem& problem) : problem_(problem), d_(problem.dimension) {
  const Ranks& ranks = *problem.ranks;
  const auto size = static_cast<std::size_t>(ranks.size());
  Ranks::ForEach<std::int64_t> told(size, {static_cast<std::int64_t>(problem.contact.size())});
  int home = 0;
  std::int64_t most = -1;
  first_.assign(1, 0);
  const Ranks::ForEach<std::int64_t> counts = ranks.exchange(std::move(told));
  for (std::size_t rank = 0; rank < size; ++rank) {
    const std::int64_t count = counts[rank].front();
    first_.push_back(first_.back() + count);
    if (count > most) {
      most = count;
      home = static_cast<int>(rank);
    }
  }
  nodes_ = GatheredNodes(ranks, home, named_by_all(problem.contact.unique_nodes()));
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

/// All but the rows, and space for these.
void GatheredContact::gather_boundary() {
  const Ranks& ranks = *problem_.ranks;
  const ContactBoundary& own = problem_.contact;
  const auto home = static_cast<std::size_t>(nodes_.home());
  Ranks::ForEach<double> told(static_cast<std::size_t>(ranks.size()));
  std::vector<double>& message = told[home];
  for (Index point = 0; point < own.size(); ++point) {
    message.insert(message.end(), {static_cast<double>(own.pair[static_cast<std::size_t>(point)]), own.weights[point],
                                   own.friction_coefficient[point], own.friction_bound[point], own.net[point]});
    append_row(own.trace, point, 1, ranks, message);
    append_row(own.own_trace, point, 1, ranks, message);
  }
  known_ = ranks.exchange(std::move(told));
  Vector solved = Vector::Zero(problem_.dof_count());
  for (const Index dof : problem_.contact_dofs) solved[dof] = 1.0;
  const Vector is_solved = nodes_.gather(solved, d_);
  if (is_home()) {
    const Index points = point_count();
    boundary_.dimension = d_;
    boundary_.pair.resize(static_cast<std::size_t>(points));
    for (Vector* values : {&boundary_.weights, &boundary_.friction_coefficient, &boundary_.friction_bound,
                           &boundary_.net, &boundary_.initial_gap})
      values->setZero(points);
    Triplets trace, own_trace;
    Index point = 0;
    for (const std::vector<double>& from : known_) {
      for (Reader numbers(from); !numbers.is_at_end(); ++point) {
        boundary_.pair[static_cast<std::size_t>(point)] = static_cast<int>(numbers.integer());
        for (Vector* values :
             {&boundary_.weights, &boundary_.friction_coefficient, &boundary_.friction_bound, &boundary_.net})
          (*values)[point] = numbers.next();
        read_row(numbers, point, 1, nodes_, trace);
        read_row(numbers, point, 1, nodes_, own_trace);
      }
    }
    boundary_.trace = matrix_of(trace, points, nodes_.count());
    boundary_.own_trace = matrix_of(own_trace, points, nodes_.count());
    for (Index dof = 0; dof < is_solved.size(); ++dof) {
      if (is_solved[dof] > 0.0) contact_dofs_.push_back(dof);
    }
    rows_ = std::make_shared<ContactRows>();
    rows_->normals.setZero(d_, points);
    rows_->tangents.assign(static_cast<std::size_t>(points), Points::Zero(d_, d_ - 1));
    rows_->slips.assign(static_cast<std::size_t>(points * (d_ - 1)), 0);
    rows_->gap_rounding.setZero(points);
    if (own.follows_motion()) rows_->revision.assign(static_cast<std::size_t>(points), 0);
  }
  gather_rows(*own.rows);
}

/// Those that have changed.
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
  Ranks::ForEach<double> told(static_cast<std::size_t>(ranks.size()));
  std::vector<double>& message = told[static_cast<std::size_t>(nodes_.home())];
  const auto append = [&message](const auto& values) {
    message.insert(message.end(), values.data(), values.data() + values.size());
  };
  for (const Index point : changed) {
    const auto at = static_cast<std::size_t>(point);
    message.push_back(static_cast<double>(point));
    append(rows.normals.col(point));
    append(rows.tangents[at]);
    for (Index row = point * (d_ - 1); row < (point + 1) * (d_ - 1); ++row)
      message.push_back(rows.slips[static_cast<std::size_t>(row)]);
    message.push_back(rows.gap_rounding[point]);
    append_row(rows.gap_operator, point, d_, ranks, message);
    for (Index row = point * (d_ - 1); row < (point + 1) * (d_ - 1); ++row)
      append_row(rows.tangential_trace, row, d_, ranks, message);
  }
  known_ = ranks.exchange(std::move(told));
  if (!is_home()) return;
  // Others may keep those of earlier stages.
  auto own = std::make_shared<ContactRows>(*rows_);
  std::vector<char> is_new(static_cast<std::size_t>(point_count()), 0);
  Triplets gap, slip;
  for (std::size_t rank = 0; rank < known_.size(); ++rank) {
    for (Reader numbers(known_[rank]); !numbers.is_at_end();) {
      const Index point = number(static_cast<int>(rank), numbers.integer());
      const auto at = static_cast<std::size_t>(point);
      is_new[at] = 1;
      numbers.fill(own->normals.col(point));
      numbers.fill(own->tangents[at]);
      for (Index row = point * (d_ - 1); row < (point + 1) * (d_ - 1); ++row)
        own->slips[static_cast<std::size_t>(row)] = numbers.next() != 0.0 ? 1 : 0;
      own->gap_rounding[point] = numbers.next();
      if (!own->revision.empty()) own->revision[at] = changes_;
      read_row(numbers, point, d_, nodes_, gap);
      for (Index row = point * (d_ - 1); row < (point + 1) * (d_ - 1); ++row) read_row(numbers, row, d_, nodes_, slip);
    }
  }
  for (Index point = 0; point < point_count() && rows_->gap_operator.rows() > 0; ++point) {
    if (is_new[static_cast<std::size_t>(point)] != 0) continue;
    for (SparseRowMatrix::InnerIterator entry(rows_->gap_operator, point); entry; ++entry)
      gap.emplace_back(static_cast<int>(point), static_cast<int>(entry.col()), entry.value());
    for (Index row = point * (d_ - 1); row < (point + 1) * (d_ - 1); ++row) {
      for (SparseRowMatrix::InnerIterator entry(rows_->tangential_trace, row); entry; ++entry)
        slip.emplace_back(static_cast<int>(row), static_cast<int>(entry.col()), entry.value());
    }
  }
  own->gap_operator = matrix_of(gap, point_count(), nodes_.count() * d_);
  own->tangential_trace = matrix_of(slip, point_count() * (d_ - 1), nodes_.count() * d_);
  rows_ = std::move(own);
}

std::unique_ptr<SemidiscreteProblem> GatheredContact::make_problem(const GatheredNodes& nodes) const {
  const Vector places = nodes.gather(problem_.nodes.reshaped(), d_);
  const Vector of_contact = nodes_.gather(problem_.nodes.reshaped(), d_);
  if (!is_home()) return nullptr;
  auto result = std::make_unique<SemidiscreteProblem>();
  result->dimension = d_;
  result->axisymmetric = problem_.axisymmetric;
  result->nodes = places.reshaped(d_, nodes.count());
  result->nodes.leftCols(nodes_.count()) = of_contact.reshaped(d_, nodes_.count());
  result->internal_force = std::make_shared<NoForce>();
  result->contact = boundary_;
  result->contact.trace = with_columns(boundary_.trace, nodes.count());
  result->contact.own_trace = with_columns(boundary_.own_trace, nodes.count());
  result->contact.rows = rows_;
  result->contact_dofs = contact_dofs_;
  result->obstacles = problem_.obstacles;
  result->is_massless.assign(static_cast<std::size_t>(result->dof_count()), 0);
  return result;
}

void GatheredContact::gather(const Stage& stage, const Vector& x, const std::vector<Index>& points, Stage& at_home) {
  const Ranks& ranks = *problem_.ranks;
  if (problem_.contact.follows_motion()) gather_rows(*stage.rows);
  const Index tangents = d_ - 1;
  stage.rows->normal_motion(x, motion_);
  if (stage.slip_offset.size() > 0) stage.rows->tangential_motion(x, slip_);
  Ranks::ForEach<double> told(static_cast<std::size_t>(ranks.size()));
  std::vector<double>& message = told[static_cast<std::size_t>(nodes_.home())];
  if (!points.empty()) {
    for (const bool has : {stage.slip_offset.size() > 0, !stage.frictionless.empty(), stage.start_gap.size() > 0,
                           stage.start_tangential_reaction.size() > 0})
      message.push_back(has ? 1.0 : 0.0);
  }
  for (const Index point : points) {
    const auto at = static_cast<std::size_t>(point);
    message.insert(message.end(),
                   {static_cast<double>(point), static_cast<double>(stage.eligible[at]),
                    stage.gap_offset[point] + stage.gap_factor * motion_[point], stage.gap_offset_rounding[point],
                    stage.frictionless.empty() ? 0.0 : static_cast<double>(stage.frictionless[at]),
                    value_of(stage.slip_offset_rounding, point), value_of(stage.start_gap, point),
                    value_of(stage.start_normal_reaction, point)});
    for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
      message.push_back(stage.slip_offset.size() > 0 ? stage.slip_offset[row] + stage.slip_factor * slip_[row] : 0.0);
      message.push_back(value_of(stage.start_tangential_reaction, row));
    }
  }
  known_ = ranks.exchange(std::move(told));
  at_home.gap_factor = stage.gap_factor;
  at_home.slip_factor = stage.slip_factor;
  if (!is_home()) return;
  const Index count = point_count();
  std::array<bool, 4> has{};
  for (const std::vector<double>& from : known_) {
    for (std::size_t k = 0; k < has.size() && !from.empty(); ++k) has[k] = has[k] || from[k] != 0.0;
  }
  at_home.rows = rows_;
  at_home.prescribed.resize(0);
  at_home.eligible.assign(static_cast<std::size_t>(count), 0);
  at_home.gap_offset.setZero(count);
  at_home.gap_offset_rounding.setZero(count);
  at_home.slip_offset.setZero(has[0] ? count * tangents : 0);
  at_home.slip_offset_rounding.setZero(has[0] ? count : 0);
  at_home.frictionless.assign(has[1] ? static_cast<std::size_t>(count) : 0, 0);
  at_home.start_gap.setZero(has[2] ? count : 0);
  at_home.start_normal_reaction.setZero(has[2] ? count : 0);
  at_home.start_tangential_reaction.setZero(has[3] ? count * tangents : 0);
  const auto set = [](Vector& values, Index i, double value) {
    if (values.size() > 0) values[i] = value;
  };
  for (std::size_t rank = 0; rank < known_.size(); ++rank) {
    Reader numbers(known_[rank]);
    if (!numbers.is_at_end()) {
      for (std::size_t k = 0; k < has.size(); ++k) numbers.next();
    }
    while (!numbers.is_at_end()) {
      const Index point = number(static_cast<int>(rank), numbers.integer());
      const auto at = static_cast<std::size_t>(point);
      at_home.eligible[at] = numbers.next() != 0.0 ? 1 : 0;
      at_home.gap_offset[point] = numbers.next();
      at_home.gap_offset_rounding[point] = numbers.next();
      const bool frictionless = numbers.next() != 0.0;
      if (has[1]) at_home.frictionless[at] = frictionless ? 1 : 0;
      set(at_home.slip_offset_rounding, point, numbers.next());
      set(at_home.start_gap, point, numbers.next());
      set(at_home.start_normal_reaction, point, numbers.next());
      for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
        set(at_home.slip_offset, row, numbers.next());
        set(at_home.start_tangential_reaction, row, numbers.next());
      }
    }
  }
}

void GatheredContact::spread(const StageSolution& at_home, const std::vector<Index>& points,
                             StageSolution& solution) const {
  const Ranks& ranks = *problem_.ranks;
  const auto size = static_cast<std::size_t>(ranks.size());
  const Index tangents = d_ - 1;
  Ranks::ForEach<std::int64_t> asked(size);
  asked[static_cast<std::size_t>(nodes_.home())].assign(points.begin(), points.end());
  const Ranks::ForEach<std::int64_t> wanted = ranks.exchange(std::move(asked));
  Ranks::ForEach<double> told(size);
  if (is_home()) {
    const bool has_mean = at_home.mean_normal_reaction.size() > 0;
    for (std::size_t rank = 0; rank < size; ++rank) {
      std::vector<double>& message = told[rank];
      message = {static_cast<double>(at_home.iterations), has_mean ? 1.0 : 0.0, at_home.end_weight};
      for (const std::int64_t own : wanted[rank]) {
        const Index point = number(static_cast<int>(rank), own);
        message.insert(message.end(), {at_home.normal_reaction[point], value_of(at_home.mean_normal_reaction, point),
                                       static_cast<double>(at_home.contact_status[static_cast<std::size_t>(point)])});
        for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
          message.push_back(value_of(at_home.tangential_reaction, row));
          message.push_back(value_of(at_home.mean_tangential_reaction, row));
        }
      }
    }
  }
  const Ranks::ForEach<double> known = ranks.exchange(std::move(told));
  Reader numbers(known[static_cast<std::size_t>(nodes_.home())]);
  const Index count = problem_.contact.size();
  const bool has_friction = problem_.contact.has_friction();
  solution.clear_mean();
  solution.iterations += static_cast<int>(numbers.integer());
  const bool has_mean = numbers.next() != 0.0;
  solution.end_weight = numbers.next();
  solution.normal_reaction.setZero(count);
  solution.contact_status.assign(static_cast<std::size_t>(count), ContactStatus::open);
  solution.tangential_reaction.setZero(has_friction ? count * tangents : 0);
  if (has_mean) solution.mean_normal_reaction.setZero(count);
  if (has_mean && has_friction) solution.mean_tangential_reaction.setZero(count * tangents);
  for (const Index point : points) {
    solution.normal_reaction[point] = numbers.next();
    const double mean = numbers.next();
    if (has_mean) solution.mean_normal_reaction[point] = mean;
    solution.contact_status[static_cast<std::size_t>(point)] = static_cast<ContactStatus>(numbers.integer());
    for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
      const double tangential = numbers.next(), mean_tangential = numbers.next();
      if (!has_friction) continue;
      solution.tangential_reaction[row] = tangential;
      if (has_mean) solution.mean_tangential_reaction[row] = mean_tangential;
    }
  }
  // Works of the path are sums over points, like those of any rank.
  if (!is_home()) return;
  solution.path_contact_work = at_home.path_contact_work;
  solution.path_friction_work = at_home.path_friction_work;
}

}  // namespace ricochet
