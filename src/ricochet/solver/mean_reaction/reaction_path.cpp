#include "ricochet/solver/mean_reaction/reaction_path.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

/// Value in place of κ: the tangential reaction is proportional to the normal one.
constexpr double on_cone = 2.0;
/// Relative distance from the cone up to which a reaction slips.
constexpr double cone_tolerance = 1e-8;
/// Part of reactions times motions below which a work has the sign of rounding.
constexpr double work_rounding = 1e-13;
/// Part of the largest reaction above which a jump is not rounding.
constexpr double path_continuity = 1e-6;
/// Number of iterations after which κ = 0 wherever friction creates energy.
constexpr int max_share_iterations = 4;

void ReactionPath::prepare(const Matrix& u, const std::vector<Index>& row_offset, bool definite) {
  u_ = &u;
  definite_ = definite;
  row_offset_ = row_offset;
  normal_rows_.assign(row_offset.begin(), row_offset.end() - 1);
  normal_u_ = u(normal_rows_, normal_rows_);
  ratio_.setZero(u.rows());
  begin_step();
}

void ReactionPath::begin_step() {
  normal_.prepare(normal_u_, definite_ ? PathMatrix::definite : PathMatrix::semidefinite);
  share_limit_.assign(normal_rows_.size(), on_cone);
  shares_frozen_ = false;
}

/// Puts a point on the cone if it slips at the end, or did at the start and is open at the end.
void ReactionPath::choose_friction(const Step& step) {
  share_.assign(normal_rows_.size(), 0.0);
  for (std::size_t i = 0; i < share_.size(); ++i) {
    if (!has_friction(i)) continue;
    const Index row = normal_rows_[i], count = row_offset_[i + 1] - row - 1;
    share_[i] = std::min(1.0, share_limit_[i]);
    const double limit = step.friction[Index(i)];
    if (!definite_ || limit == 0.0 || share_limit_[i] < on_cone) continue;
    const Vector& of = step.end[row] > 0.0 ? step.end : step.start;
    const auto tangential = of.segment(row + 1, count);
    if (of[row] <= 0.0 || tangential.norm() < (1.0 - cone_tolerance) * limit * of[row]) continue;
    share_[i] = on_cone;
    ratio_.segment(row + 1, count) = tangential / of[row];
  }
}

/// Sets the friction that is not proportional to normal reactions; zero on normal rows.
void ReactionPath::set_friction(const Step& step) {
  friction_start_.setZero(step.end.size());
  friction_end_.setZero(step.end.size());
  for (std::size_t i = 0; i < share_.size(); ++i) {
    if (share_[i] == on_cone) continue;
    for (Index row = row_offset_[i] + 1; row < row_offset_[i + 1]; ++row) {
      friction_end_[row] = step.end[row];
      friction_start_[row] = step.end[row] + share_[i] * (step.start[row] - step.end[row]);
    }
  }
}

bool ReactionPath::follow_normal(const Step& step) {
  selected_ = &normal_;
  if (std::ranges::find(share_, on_cone) != share_.end()) {
    path_u_ = normal_u_;
    for (std::size_t i = 0; i < share_.size(); ++i) {
      if (share_[i] != on_cone) continue;
      for (Index row = row_offset_[i] + 1; row < row_offset_[i + 1]; ++row)
        path_u_.col(Index(i)) += ratio_[row] * (*u_)(normal_rows_, row);
    }
    selected_ = &along_;
    along_.prepare(path_u_, PathMatrix::general);
  }
  const auto without_normal = [&](const Vector& q, const Vector& friction, Vector& of_normals) {
    all_ = q;
    all_.noalias() += *u_ * friction;
    of_normals = all_(normal_rows_);
  };
  without_normal(step.q0, friction_start_, normal_q0_);
  without_normal(step.q1, friction_end_, normal_q1_);
  if (!selected_->follow(normal_q0_, normal_q1_, step.eligible, step.pressing)) return false;
  return selected_ == &normal_ || leads_to_end(step);
}

/// Without symmetry reactions need not be unique: they may jump along the path, or end elsewhere than at ρ₁. The work
/// along such a path is not that of the step.
bool ReactionPath::leads_to_end(const Step& step) const {
  double size = step.end.lpNorm<Eigen::Infinity>();
  for (std::size_t k = 0; k < along_.pieces(); ++k)
    size = std::max(size, along_.piece(k).last.lpNorm<Eigen::Infinity>());
  const double rounding = path_continuity * size;
  for (std::size_t k = 1; k < along_.pieces(); ++k) {
    if ((along_.piece(k).first - along_.piece(k - 1).last).lpNorm<Eigen::Infinity>() > rounding) return false;
  }
  for (std::size_t i = 0; i < normal_rows_.size(); ++i) {
    if (std::abs(along_.end()[Index(i)] - step.end[normal_rows_[i]]) > rounding) return false;
  }
  return true;
}

/// Computes ρ and y at a position on the path.
void ReactionPath::compute_state(const Step& step, double time, const Vector& normal, Vector& reaction,
                                 Vector& motion) const {
  reaction = (1.0 - time) * friction_start_ + time * friction_end_;
  for (std::size_t i = 0; i < share_.size(); ++i) {
    const double own = normal[Index(i)];
    reaction[normal_rows_[i]] = own;
    if (share_[i] != on_cone) continue;
    for (Index row = row_offset_[i] + 1; row < row_offset_[i + 1]; ++row) reaction[row] = ratio_[row] * own;
  }
  motion = (1.0 - time) * step.q0 + time * step.q1;
  motion.noalias() += *u_ * reaction;
}

/// Computes the mean, and the work per row; both reactions and motions are linear in a piece.
void ReactionPath::find_works(const Step& step) {
  mean_.setZero(step.end.size());
  for (std::size_t k = 0; k < selected_->pieces(); ++k) {
    const NormalPath::Piece& piece = selected_->piece(k);
    compute_state(step, piece.begin, piece.first, reaction_before_, motion_before_);
    if (k == 0) work_ = reaction_before_.cwiseProduct(motion_before_);
    compute_state(step, piece.end, piece.last, reaction_, motion_);
    mean_ += (0.5 * (piece.end - piece.begin)) * (reaction_before_ + reaction_);
    work_ += 0.5 * (reaction_before_ + reaction_).cwiseProduct(motion_ - motion_before_);
  }
}

/// Reduces the shares of points at which friction creates energy.
bool ReactionPath::dissipates(const Step& step, bool is_last) {
  const double size = step.end.lpNorm<Eigen::Infinity>() + step.start.lpNorm<Eigen::Infinity>();
  const double rounding =
      work_rounding * size * (step.q0.lpNorm<Eigen::Infinity>() + step.q1.lpNorm<Eigen::Infinity>());
  bool all = true;
  friction_work_ = 0.0;
  for (std::size_t i = 0; i < share_.size(); ++i) {
    double work = 0.0, at_end = 0.0, at_start = 0.0;
    for (Index row = row_offset_[i] + 1; row < row_offset_[i + 1]; ++row) {
      work += work_[row];
      at_end += step.end[row] * motion_[row];
      at_start += step.start[row] * motion_[row];
    }
    friction_work_ += work;
    double& share = share_[i];
    const bool reverses = share != on_cone && at_start > rounding;
    if (share == 0.0 || (work <= rounding && !reverses)) continue;
    // The work is that of κ = 0 plus a part proportional to κ.
    const bool can_shrink = share != on_cone && !reverses && !is_last && at_end < -rounding && work > at_end;
    share = can_shrink ? std::min(0.9 * share, share * at_end / (at_end - work)) : 0.0;
    all = false;
  }
  return all;
}

bool ReactionPath::follow(const Step& step) {
  choose_friction(step);
  for (int iteration = 0;; ++iteration) {
    set_friction(step);
    if (!follow_normal(step)) {
      if (std::ranges::find(share_, on_cone) == share_.end()) return false;
      std::ranges::replace(share_, on_cone, 1.0);
      continue;
    }
    find_works(step);
    if (dissipates(step, iteration >= max_share_iterations)) break;
  }
  if (shares_frozen_) share_limit_ = share_;
  return true;
}

}  // namespace ricochet
