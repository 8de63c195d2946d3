#include <algorithm>
#include <array>

#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/gathered/number_reader.hpp"

/// @file Transfer of stages and their solutions, point by point, between the ranks and the root of their contact.
namespace ricochet {

namespace {

// Message of write_points: the four flags of stage_part; for each point its index, whether it is eligible, q, rounding
// of q, whether it is frictionless, rounding of p, gap and normal reaction at the start; for each tangent p and the
// reaction at the start. Message of write_solution: iterations, whether there are means, their weight; for each point
// normal reaction, its mean, status; for each tangent reaction, its mean.

/// Vectors that a stage may have.
constexpr std::size_t stage_parts = 4;
namespace stage_part {
enum : std::size_t { slip, frictionless, start, start_friction };
}

/// Entry of a vector per point or per tangent; 0 if it is not part of the stage.
double value_of(const Vector& values, Index i) {
  return values.size() > 0 ? values[i] : 0.0;
}

void set_value(Vector& values, Index i, double value) {
  if (values.size() > 0) values[i] = value;
}

void add_value(Vector& values, Index i, double value) {
  if (values.size() > 0) values[i] += value;
}

}  // namespace

void GatheredContact::gather(const LinearStage& stage, const Vector& x, const std::vector<Index>& points,
                             Stage& at_root) {
  const Ranks& ranks = *problem_.ranks;
  if (problem_.contact.follows_motion()) gather_rows(stage.rows);
  stage.rows.normal_motion(x, motion_);
  if (stage.conditions.slip.offset.size() > 0) stage.rows.tangential_motion(x, slip_);
  Ranks::ForEach<double> sent(static_cast<std::size_t>(ranks.size()));
  if (!points.empty()) write_points(stage, points, sent[static_cast<std::size_t>(nodes_.root())]);
  received_ = ranks.exchange(std::move(sent));
  at_root.conditions.gap.factor = stage.conditions.gap.factor;
  at_root.conditions.slip.factor = stage.conditions.slip.factor;
  if (is_root()) read_points(at_root);
}

void GatheredContact::write_points(const LinearStage& stage, const std::vector<Index>& points,
                                   std::vector<double>& message) const {
  const Index tangents = d_ - 1;
  const bool slips = stage.conditions.slip.offset.size() > 0;
  for (const bool has : {slips, !stage.conditions.frictionless.empty(), stage.start.gap.size() > 0,
                         stage.start.tangential_reaction.size() > 0})
    message.push_back(has ? 1.0 : 0.0);
  for (const Index point : points) {
    const auto at = static_cast<std::size_t>(point);
    message.insert(
        message.end(),
        {static_cast<double>(point), static_cast<double>(stage.conditions.eligible[at]),
         stage.conditions.gap.offset[point] + stage.conditions.gap.factor * motion_[point],
         stage.conditions.gap.rounding[point],
         stage.conditions.frictionless.empty() ? 0.0 : static_cast<double>(stage.conditions.frictionless[at]),
         value_of(stage.conditions.slip.rounding, point), value_of(stage.start.gap, point),
         value_of(stage.start.normal_reaction, point)});
    for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
      message.push_back(slips ? stage.conditions.slip.offset[row] + stage.conditions.slip.factor * slip_[row] : 0.0);
      message.push_back(value_of(stage.start.tangential_reaction, row));
    }
  }
}

void GatheredContact::read_points(Stage& at_root) const {
  const Index count = point_count(), tangents = d_ - 1;
  std::array<bool, stage_parts> has{};
  for (const std::vector<double>& from : received_) {
    for (std::size_t k = 0; k < stage_parts && !from.empty(); ++k) has[k] = has[k] || from[k] != 0.0;
  }
  at_root.rows = rows_;
  at_root.right_hand_side.prescribed.resize(0);
  at_root.conditions.eligible.assign(static_cast<std::size_t>(count), 0);
  at_root.conditions.gap.offset.setZero(count);
  at_root.conditions.gap.rounding.setZero(count);
  at_root.conditions.slip.offset.setZero(has[stage_part::slip] ? count * tangents : 0);
  at_root.conditions.slip.rounding.setZero(has[stage_part::slip] ? count : 0);
  at_root.conditions.frictionless.assign(has[stage_part::frictionless] ? static_cast<std::size_t>(count) : 0, 0);
  at_root.start.gap.setZero(has[stage_part::start] ? count : 0);
  at_root.start.normal_reaction.setZero(has[stage_part::start] ? count : 0);
  at_root.start.tangential_reaction.setZero(has[stage_part::start_friction] ? count * tangents : 0);
  for (std::size_t rank = 0; rank < received_.size(); ++rank) {
    NumberReader numbers(received_[rank]);
    for (std::size_t k = 0; k < stage_parts && !numbers.is_at_end(); ++k) numbers.next();
    while (!numbers.is_at_end()) {
      const Index point = number(static_cast<int>(rank), numbers.integer());
      const auto at = static_cast<std::size_t>(point);
      at_root.conditions.eligible[at] = numbers.next() != 0.0 ? 1 : 0;
      at_root.conditions.gap.offset[point] = numbers.next();
      at_root.conditions.gap.rounding[point] = numbers.next();
      const bool is_frictionless = numbers.next() != 0.0;
      if (has[stage_part::frictionless]) at_root.conditions.frictionless[at] = is_frictionless ? 1 : 0;
      set_value(at_root.conditions.slip.rounding, point, numbers.next());
      set_value(at_root.start.gap, point, numbers.next());
      set_value(at_root.start.normal_reaction, point, numbers.next());
      for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
        set_value(at_root.conditions.slip.offset, row, numbers.next());
        set_value(at_root.start.tangential_reaction, row, numbers.next());
      }
    }
  }
}

void GatheredContact::scatter(const StageSolution& at_root, const std::vector<Index>& points,
                              StageSolution& solution) const {
  const Ranks& ranks = *problem_.ranks;
  const auto size = static_cast<std::size_t>(ranks.size());
  Ranks::ForEach<std::int64_t> requested(size);
  requested[static_cast<std::size_t>(nodes_.root())].assign(points.begin(), points.end());
  const Ranks::ForEach<std::int64_t> requests = ranks.exchange(std::move(requested));
  Ranks::ForEach<double> sent(size);
  for (std::size_t rank = 0; is_root() && rank < size; ++rank)
    write_solution(at_root, static_cast<int>(rank), requests[rank], sent[rank]);
  const Ranks::ForEach<double> received = ranks.exchange(std::move(sent));
  read_solution(received[static_cast<std::size_t>(nodes_.root())], points, solution);
  // The works of the ranks are summed.
  if (!is_root()) return;
  solution.path_contact_work = at_root.path_contact_work;
  solution.path_friction_work = at_root.path_friction_work;
}

void GatheredContact::write_solution(const StageSolution& at_root, int rank, const std::vector<std::int64_t>& points,
                                     std::vector<double>& message) const {
  const Index tangents = d_ - 1;
  message = {static_cast<double>(at_root.iterations), at_root.mean_normal_reaction.size() > 0 ? 1.0 : 0.0,
             at_root.end_weight};
  for (const std::int64_t of_rank : points) {
    const Index point = number(rank, of_rank);
    message.insert(message.end(), {at_root.normal_reaction[point], value_of(at_root.mean_normal_reaction, point),
                                   static_cast<double>(at_root.contact_status[static_cast<std::size_t>(point)])});
    for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
      message.push_back(value_of(at_root.tangential_reaction, row));
      message.push_back(value_of(at_root.mean_tangential_reaction, row));
    }
  }
}

void GatheredContact::read_solution(const std::vector<double>& message, const std::vector<Index>& points,
                                    StageSolution& solution) const {
  const Index count = problem_.contact.size(), tangents = d_ - 1;
  const bool has_friction = problem_.contact.has_friction();
  NumberReader numbers(message);
  solution.iterations += static_cast<int>(numbers.integer());
  const bool has_mean = numbers.next() != 0.0;
  solution.end_weight = numbers.next();
  if (has_mean) solution.mean_normal_reaction.setZero(count);
  if (has_mean && has_friction) solution.mean_tangential_reaction.setZero(count * tangents);
  for (const Index point : points) {
    add_value(solution.normal_reaction, point, numbers.next());
    set_value(solution.mean_normal_reaction, point, numbers.next());
    ContactStatus& status = solution.contact_status[static_cast<std::size_t>(point)];
    status = std::max(status, static_cast<ContactStatus>(numbers.integer()));
    for (Index row = point * tangents; row < (point + 1) * tangents; ++row) {
      add_value(solution.tangential_reaction, row, numbers.next());
      set_value(solution.mean_tangential_reaction, row, numbers.next());
    }
  }
}

}  // namespace ricochet
