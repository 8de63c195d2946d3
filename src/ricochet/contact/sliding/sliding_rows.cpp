#include "ricochet/contact/sliding/sliding_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/contact/contact_directions.hpp"
#include "ricochet/contact/sliding/rigid_part.hpp"
#include "ricochet/fem/displacement_space.hpp"

namespace ricochet {

/// Largest correction, relative to the norm of a row.
constexpr double most_correction = 0.25;
/// Multiple of the rounding error below which a motion has no meaningful direction.
constexpr double least_motion = 1e3;

SlidingRows::SlidingRows(const Points& nodes) : nodes_(nodes), extent_(extent(nodes)) {}

void SlidingRows::begin(const Vector& displacement, const Vector* start) {
  middle_ = displacement;
  if (start == nullptr) return;
  middle_ = 0.5 * (*start + displacement);
  step_ = displacement - *start;
}

void SlidingRows::correct(SlidingView& view, double least, double most, double rounding) {
  const Index d = dimension();
  positions_.clear();
  motions_.clear();
  double product = 0.0, size = 0.0;
  for (const auto& [node, value] : view.row) {
    SlidingVector position = SlidingVector::Zero(), motion = position;
    position.head(d) = nodes_.col(node) + middle_.segment(node * d, d);
    motion.head(d) = step_.segment(node * d, d);
    product += value.dot(motion);
    size += value.squaredNorm();
    positions_.push_back(position);
    motions_.push_back(motion);
  }
  const double missing = std::clamp(product, least, most) - product;
  if (std::abs(missing) <= 0.25 * rounding) return;
  remove_rigid_part(positions_, d == 2, motions_);
  double square = 0.0;
  for (const SlidingVector& motion : motions_) square += motion.squaredNorm();
  if (!(std::sqrt(square) > least_motion * std::numeric_limits<double>::epsilon() * extent_)) return;
  const double factor = std::min(missing / square, most_correction * std::sqrt(size / square));
  for (std::size_t j = 0; j < view.row.size(); ++j) view.row[j].second += factor * motions_[j];
}

void SlidingRows::write(const SlidingPair::Point& point, const SlidingView& view, ContactRows& rows) {
  const Index d = dimension();
  entries_.clear();
  for (const auto& [node, value] : view.row) {
    for (Index j = 0; j < d; ++j) entries_.emplace_back(node * d + j, value[j]);
  }
  gap_writer_.set(point.number, entries_);
  set_directions(point, view.direction, rows);
  trace_.clear();
  for (const auto& [node, weight] : view.own) trace_.emplace_back(node, weight);
  for (const auto& [node, weight] : view.opposite) trace_.emplace_back(node, -weight);
  std::ranges::sort(trace_);
  write_slips(point.number, rows);
}

void SlidingRows::write_plane(const SlidingPair::Point& point, const SlidingVector& normal, ContactRows& rows) {
  const Index d = dimension();
  trace_.assign(point.multiplier.trace.begin(), point.multiplier.trace.end());
  std::ranges::sort(trace_);
  entries_.clear();
  for (const auto& [node, weight] : trace_) {
    for (Index j = 0; j < d; ++j) entries_.emplace_back(node * d + j, weight * normal[j]);
  }
  gap_writer_.set(point.number, entries_);
  set_directions(point, normal, rows);
  write_slips(point.number, rows);
}

void SlidingRows::set_directions(const SlidingPair::Point& point, const SlidingVector& direction,
                                 ContactRows& rows) const {
  const Index d = dimension();
  const Vector normal = direction.head(d);
  const ContactTangents tangents =
      tangents_at(0, normal, [&](Index, int component) { return point.is_free[std::size_t(component)]; });
  rows.normals.col(point.number) = normal;
  rows.tangents[std::size_t(point.number)] = tangents.directions;
  for (Index j = 0; j < d - 1; ++j)
    rows.slips[std::size_t(point.number * (d - 1) + j)] = tangents.slips[std::size_t(j)] ? 1 : 0;
}

/// Writes t ⊗ τ with the trace in trace_.
void SlidingRows::write_slips(Index point, const ContactRows& rows) {
  const Index d = dimension();
  for (Index j = 0; j < d - 1; ++j) {
    const Index row = point * (d - 1) + j;
    entries_.clear();
    if (rows.slips[std::size_t(row)] != 0) {
      const auto tangent = rows.tangents[std::size_t(point)].col(j);
      for (const auto& [node, weight] : trace_) {
        for (Index c = 0; c < d; ++c) entries_.emplace_back(node * d + c, weight * tangent[c]);
      }
    }
    slip_writer_.set(row, entries_);
  }
}

void SlidingRows::finish(ContactRows& rows) {
  changed_.assign(std::size_t(rows.size()), 0);
  gap_writer_.write(rows.gap_operator, changed_);
  const Index tangents = dimension() - 1;
  slip_changed_.assign(std::size_t(rows.size() * tangents), 0);
  slip_writer_.write(rows.tangential_trace, slip_changed_);
  ++revision_;
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    const auto first = slip_changed_.begin() + std::ptrdiff_t(i) * tangents;
    if (changed_[i] != 0 || std::any_of(first, first + tangents, [](char c) { return c != 0; }))
      rows.revision[i] = revision_;
  }
}

}  // namespace ricochet
