#include "ricochet/linear_algebra/anderson_acceleration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ricochet {

void AndersonAcceleration::distribute(const Ranks& ranks, Vector is_counted) {
  ranks_ = &ranks;
  is_counted_ = std::move(is_counted);
}

template <class One, class Other>
double AndersonAcceleration::dot(const One& one, const Other& other) const {
  return ranks_->are_several() ? ranks_->sum(one.cwiseProduct(is_counted_).dot(other)) : one.dot(other);
}

template <class Values>
double AndersonAcceleration::norm(const Values& values) const {
  return ranks_->are_several() ? std::sqrt(dot(values, values)) : values.norm();
}

void AndersonAcceleration::advance(const Vector& point, const Vector& image, Vector& next) {
  if (residual_changes_.rows() != image.size()) {
    for (Matrix* const each : {&image_changes_, &residual_changes_, &directions_, &moves_})
      each->resize(image.size(), depth_);
    restart();
  }
  std::swap(residual_, last_residual_);
  residual_ = image - point;
  if (stored_ >= 0) store_changes(image);
  stored_ = std::max<Index>(stored_, 0);
  image_ = image;
  next = image;
  combine(next);
}

void AndersonAcceleration::store_changes(const Vector& image) {
  newest_ = (newest_ + 1) % depth_;
  stored_ = std::min(stored_ + 1, depth_);
  image_changes_.col(newest_) = image - image_;
  residual_changes_.col(newest_) = residual_ - last_residual_;
}

/// Solves the least-squares problem by modified Gram–Schmidt, orthogonalizing each direction twice. Changes shrink by
/// orders of magnitude, so each is normalized, and one that newer ones nearly span is left out.
void AndersonAcceleration::combine(Vector& next) {
  constexpr double same_direction = 1e-10;
  remaining_ = residual_;
  Index count = 0;
  for (Index age = 0; age < stored_; ++age) {
    const Index column = (newest_ - age + depth_) % depth_;
    const double length = norm(residual_changes_.col(column));
    if (length == 0.0) continue;
    auto direction = directions_.col(count), move = moves_.col(count);
    direction = residual_changes_.col(column) / length;
    move = image_changes_.col(column) / length;
    for (int pass = 0; pass < 2; ++pass) {
      for (Index k = 0; k < count; ++k) {
        const double part = dot(directions_.col(k), direction);
        direction -= part * directions_.col(k);
        move -= part * moves_.col(k);
      }
    }
    const double own = norm(direction);
    if (own <= same_direction) continue;
    direction /= own;
    move /= own;
    const double weight = dot(direction, remaining_);
    remaining_ -= weight * direction;
    next -= weight * move;
    ++count;
  }
}

}  // namespace ricochet
