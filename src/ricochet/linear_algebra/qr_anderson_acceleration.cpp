#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ricochet {

namespace {

/// Part of a change that is orthogonal to the others, relative to its length, up to which these span it.
constexpr double same_direction = 1e-10;
/// Rows of the vectors that are processed at a time: those of all directions then stay in the cache.
constexpr Index strip_rows = 256;

}  // namespace

void QrAndersonAcceleration::resize(Index size) {
  for (Vector* const each : {&image_, &residual_}) each->resize(size);
  for (Matrix* const each : {&directions_, &image_changes_}) each->resize(size, depth_);
  triangle_.setZero(depth_, depth_);
  for (Vector* const each : {&lengths_, &on_residual_, &correction_}) each->setZero(depth_);
  sums_.resize(2 * depth_ + 1);
  slots_.resize(std::size_t(depth_));
  std::iota(slots_.begin(), slots_.end(), 0);
  rotations_.reserve(slots_.size());
  restart();
}

/// Adds Qᵀ × values, on a strip, to the sums at `first`.
template <class Values>
void QrAndersonAcceleration::add_products(Index begin, const Values& values, Index first) {
  sums_.segment(first, count_).noalias() += directions_.block(begin, 0, values.size(), count_).transpose() * values;
}

template <class Visitor>
void QrAndersonAcceleration::sum_over_strips(const Visitor& visit) {
  sums_.setZero();
  for (Index begin = 0; begin < image_.size(); begin += strip_rows)
    visit(begin, std::min(strip_rows, image_.size() - begin));
}

void QrAndersonAcceleration::advance(const Vector& point, const Vector& image, Vector& next) {
  if (image_.size() != image.size()) resize(image.size());
  if (!has_point_) {
    has_point_ = true;
    count_ = 0;
    residual_ = image - point;
    image_ = image;
    next = image;
    return;
  }
  if (count_ == depth_) discard(0);
  const double length = enter(point, image);
  if (!std::isfinite(length)) {
    restart();
    next = image;
    return;
  }
  if (length > 0.0) append(length);
  combine(next);
}

/// Enters a point: replaces the last one, and sets the newest change and its products with Q, and Qᵀf. Returns the
/// length of the change.
double QrAndersonAcceleration::enter(const Vector& point, const Vector& image) {
  const Index slot = slots_[std::size_t(count_)];
  sum_over_strips([&](Index begin, Index size) {
    apply_rotations(begin, size);
    auto change = directions_.col(count_).segment(begin, size);
    auto residual = residual_.segment(begin, size);
    auto last_image = image_.segment(begin, size);
    change = (image.segment(begin, size) - point.segment(begin, size)) - residual;
    residual = image.segment(begin, size) - point.segment(begin, size);
    image_changes_.col(slot).segment(begin, size) = image.segment(begin, size) - last_image;
    last_image = image.segment(begin, size);
    add_products(begin, change, 0);
    add_products(begin, residual, depth_);
    sums_[2 * depth_] += change.squaredNorm();
  });
  rotations_.clear();
  coefficients() = sums_.head(count_);
  on_residual_.head(count_) = sums_.segment(depth_, count_);
  return std::sqrt(sums_[2 * depth_]);
}

/// Appends the newest change, whose products with Q are known, to Q and R. Discards columns if they span it.
void QrAndersonAcceleration::append(double length) {
  lengths_[count_] = length;
  coefficients() /= length;
  subtract(length, coefficients());
  orthogonalize_again();
  while (own_length() <= same_direction && count_ > 0) {
    discard(oldest_in_span());
    return_lost_part();
    orthogonalize_again();
  }
  const double own = own_length();
  triangle_(count_, count_) = own;
  sum_over_strips([&](Index begin, Index size) {
    auto newest = directions_.col(count_).segment(begin, size);
    newest /= own;
    sums_[0] += newest.dot(residual_.segment(begin, size));
  });
  on_residual_[count_] = sums_[0];
  ++count_;
}

/// Subtracts what a first pass has left in the directions of Q.
void QrAndersonAcceleration::orthogonalize_again() {
  correction_.head(count_) = sums_.head(count_);
  coefficients() += correction_.head(count_);
  subtract(1.0, correction_.head(count_));
}

/// Divides the newest change by a number and subtracts Q × parts; sums its products with Q, and its squared length.
template <class Parts>
void QrAndersonAcceleration::subtract(double divisor, const Parts& parts) {
  sum_over_strips([&](Index begin, Index size) {
    auto newest = directions_.col(count_).segment(begin, size);
    if (divisor != 1.0) newest /= divisor;
    newest.noalias() -= directions_.block(begin, 0, size, count_) * parts;
    add_products(begin, newest, 0);
    sums_[2 * depth_] += newest.squaredNorm();
  });
}

/// Returns the oldest column without which the others do not span the newest change any more. Without column k, the
/// change has the part z·h/|z| along the direction z that is lost, with h its products with Q and Rᵀz = e_k.
Index QrAndersonAcceleration::oldest_in_span() {
  const auto triangle = triangle_.topLeftCorner(count_, count_).triangularView<Eigen::Upper>();
  auto lost = correction_.head(count_);
  for (Index column = 0; column < count_; ++column) {
    lost.setZero();
    lost[column] = 1.0;
    triangle.transpose().solveInPlace(lost);
    if (std::abs(lost.dot(coefficients())) > same_direction * lost.norm()) return column;
  }
  return 0;
}

/// Removes a column from R and Qᵀf. The rotations are still to be applied to Q, whose column `count_` is then the
/// direction that is lost.
void QrAndersonAcceleration::discard(Index column) {
  const Index last = std::min(count_, depth_ - 1);  // the newest change, unless Q is full
  const auto slot = slots_.begin() + column;
  std::rotate(slot, slot + 1, slots_.begin() + last + 1);
  for (Index k = column; k < last; ++k) {
    triangle_.col(k).head(k + 2) = triangle_.col(k + 1).head(k + 2);
    lengths_[k] = lengths_[k + 1];
  }
  --count_;
  first_rotated_ = column;
  for (Index k = column; k < count_; ++k) {
    Eigen::JacobiRotation<double> rotation;
    rotation.makeGivens(triangle_(k, k), triangle_(k + 1, k));
    triangle_.middleCols(k, last - k).applyOnTheLeft(k, k + 1, rotation.adjoint());
    on_residual_.applyOnTheLeft(k, k + 1, rotation.adjoint());
    rotations_.push_back(rotation);
  }
}

void QrAndersonAcceleration::apply_rotations(Index begin, Index size) {
  auto directions = directions_.middleRows(begin, size);
  for (Index k = 0; k < Index(rotations_.size()); ++k)
    directions.applyOnTheRight(first_rotated_ + k, first_rotated_ + k + 1, rotations_[std::size_t(k)]);
}

/// Rotates Q and returns the part of the newest change along the direction that is lost to it.
void QrAndersonAcceleration::return_lost_part() {
  const double part = triangle_(count_, count_);
  sum_over_strips([&](Index begin, Index size) {
    apply_rotations(begin, size);
    auto lost = directions_.col(count_).segment(begin, size);
    lost = part * lost + directions_.col(count_ + 1).segment(begin, size);
    add_products(begin, lost, 0);
  });
  rotations_.clear();
}

void QrAndersonAcceleration::combine(Vector& next) {
  auto weights = on_residual_.head(count_);
  triangle_.topLeftCorner(count_, count_).triangularView<Eigen::Upper>().solveInPlace(weights);
  weights.array() /= lengths_.head(count_).array();
  next.resize(image_.size());
  for (Index begin = 0; begin < next.size(); begin += strip_rows) {
    auto strip = next.segment(begin, std::min(strip_rows, next.size() - begin));
    strip = image_.segment(begin, strip.size());
    for (Index k = 0; k < count_; ++k)
      strip -= weights[k] * image_changes_.col(slots_[std::size_t(k)]).segment(begin, strip.size());
  }
}

}  // namespace ricochet
