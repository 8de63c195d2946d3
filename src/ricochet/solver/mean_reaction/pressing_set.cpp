#include "ricochet/solver/mean_reaction/pressing_set.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/base/dense_decompositions.hpp"

namespace ricochet {

/// Part of U_pp that must remain after elimination of the set.
constexpr double singular = 1e-13;

void PressingSet::prepare(const Matrix& u) {
  u_ = &u;
  points_.clear();
  indices_.assign(std::size_t(u.rows()), -1);
  if (inverse_.rows() < u.rows()) inverse_.resize(u.rows(), u.rows());
}

bool PressingSet::renew() {
  if (points_.empty()) return true;
  inverse() = PivotedLu((*u_)(points_, points_)).inverse();
  return inverse().allFinite();
}

bool PressingSet::set_points(const std::vector<char>& marks) {
  added_.clear();
  removed_.clear();
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const bool is_in = indices_[i] >= 0, is_marked = marks[i] != 0;
    if (is_marked && !is_in) added_.push_back(Index(i));
    if (!is_marked && is_in) removed_.push_back(Index(i));
  }
  // A change costs about three squares, a new inverse about two cubes.
  if (2 * (added_.size() + removed_.size()) < points_.size() + 2) {
    const auto remove_one = [&](Index point) { return remove(point); };
    const auto add_one = [&](Index point) { return add(point); };
    if (std::ranges::all_of(removed_, remove_one) && std::ranges::all_of(added_, add_one)) return true;
  }
  points_.clear();
  for (std::size_t i = 0; i < marks.size(); ++i) {
    indices_[i] = marks[i] != 0 ? count() : -1;
    if (marks[i] != 0) points_.push_back(Index(i));
  }
  return renew();
}

bool PressingSet::add(Index point) {
  const Index n = count();
  column_.noalias() = inverse() * (*u_)(points_, point);
  row_.noalias() = inverse().transpose() * (*u_)(point, points_).transpose();
  const double own = (*u_)(point, point) - (*u_)(point, points_).dot(column_);
  if (!(std::abs(own) > singular * std::abs((*u_)(point, point)))) return false;
  inverse().noalias() += (column_ / own) * row_.transpose();
  inverse_.col(n).head(n) = -column_ / own;
  inverse_.row(n).head(n) = -row_.transpose() / own;
  inverse_(n, n) = 1.0 / own;
  indices_[std::size_t(point)] = n;
  points_.push_back(point);
  return true;
}

/// Moves the last point to the position of the removed one.
bool PressingSet::remove(Index point) {
  const Index last = count() - 1, index = indices_[std::size_t(point)];
  if (index != last) {
    inverse().row(index).swap(inverse().row(last));
    inverse().col(index).swap(inverse().col(last));
    points_[std::size_t(index)] = points_[std::size_t(last)];
    indices_[std::size_t(points_[std::size_t(index)])] = index;
  }
  points_.pop_back();
  indices_[std::size_t(point)] = -1;
  const double own = inverse_(last, last);
  if (own == 0.0 || !std::isfinite(own)) return false;
  column_ = inverse_.col(last).head(last) / own;
  row_ = inverse_.row(last).head(last).transpose();
  inverse().noalias() -= column_ * row_.transpose();
  return true;
}

void PressingSet::solve(const Vector& q, Vector& r) {
  r.setZero(q.size());
  if (points_.empty()) return;
  on_set_ = -q(points_);
  result_.noalias() = inverse() * on_set_;
  r(points_) = result_;
  // Refines with the residual: the inverse of points that nearly depend on one another has few digits.
  motion_ = q;
  add_motion(r, motion_);
  on_set_ = -motion_(points_);
  result_.noalias() += inverse() * on_set_;
  r(points_) = result_;
}

void PressingSet::add_motion(const Vector& r, Vector& y) const {
  for (const Index i : points_) y += r[i] * u_->col(i);
}

void PressingSet::add_inverse(double factor, Matrix& sum) const {
  if (points_.empty()) return;
  sum(points_, points_) += factor * inverse_.topLeftCorner(count(), count());
}

}  // namespace ricochet
