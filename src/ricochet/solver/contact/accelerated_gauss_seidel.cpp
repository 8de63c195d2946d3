#include <Eigen/Cholesky>
#include <cmath>

#include "ricochet/solver/contact/gauss_seidel.hpp"

namespace ricochet {

/// Growth of the change from sweep to sweep that indicates a bad extrapolation.
constexpr double growth = 2.0;
/// Regularization relative to the largest product of residual steps: keeps nearly parallel ones apart.
constexpr double ridge = 1e-13;

void AcceleratedGaussSeidel::start(const ContactSystem& system) {
  if (residual_steps_.rows() != system.rows()) {
    residual_steps_.resize(system.rows(), depth);
    reaction_steps_.resize(system.rows(), depth);
    motion_steps_.resize(system.rows(), depth);
  }
  stored_ = next_ = 0;
  has_last_ = false;
  change_ = 0.0;
  sweeps_.restart();
}

bool AcceleratedGaussSeidel::sweep(const ContactSystem& system, ContactIterate& iterate) {
  if (has_last_) {
    iterate.reaction = start_reaction_;
    iterate.motion = start_motion_;
  } else {
    start_reaction_ = iterate.reaction;
  }
  const bool changed = sweeps_.sweep(system, 1.0, iterate, true);
  residual_ = iterate.reaction - start_reaction_;
  const double change = residual_.norm();
  if (has_last_ && stored_ > 0 && change > growth * change_) {
    // Back to the end of the previous sweep.
    start_reaction_ = end_reaction_;
    start_motion_ = end_motion_;
    stored_ = next_ = 0;
    has_last_ = false;
    iterate.reaction = end_reaction_;
    iterate.motion = end_motion_;
    return true;
  }
  if (has_last_) {
    residual_steps_.col(next_) = residual_ - last_residual_;
    reaction_steps_.col(next_) = iterate.reaction - end_reaction_;
    motion_steps_.col(next_) = iterate.motion - end_motion_;
    stored_ = std::min(stored_ + 1, depth);
    for (Index k = 0; k < stored_; ++k)
      products_(k, next_) = products_(next_, k) = residual_steps_.col(k).dot(residual_steps_.col(next_));
    next_ = (next_ + 1) % depth;
  }
  change_ = change;
  end_reaction_ = iterate.reaction;
  end_motion_ = iterate.motion;
  last_residual_ = residual_;
  has_last_ = true;
  extrapolate();
  return changed;
}

/// The weights of an extrapolation add up to one: an error common to all earlier u is that of the next start.
void AcceleratedGaussSeidel::correct(const Vector& motion) {
  start_motion_ += motion - end_motion_;
  end_motion_ = motion;
}

void AcceleratedGaussSeidel::extrapolate() {
  start_reaction_ = end_reaction_;
  start_motion_ = end_motion_;
  if (stored_ == 0) return;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, depth, depth>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, depth, 1>;
  Small system = products_.topLeftCorner(stored_, stored_);
  // Each step is scaled by its own size, so that the small ones of late sweeps count.
  SmallVector scale(stored_), right(stored_);
  for (Index k = 0; k < stored_; ++k) {
    scale[k] = system(k, k) > 0.0 ? 1.0 / std::sqrt(system(k, k)) : 0.0;
    right[k] = scale[k] * residual_steps_.col(k).dot(residual_);
  }
  system = scale.asDiagonal() * system * scale.asDiagonal();
  system.diagonal().array() += ridge;
  const Eigen::LDLT<Small> factor(system);
  const SmallVector weights = scale.cwiseProduct(SmallVector(factor.solve(right)));
  if (!weights.allFinite()) return;
  start_reaction_.noalias() -= reaction_steps_.leftCols(stored_) * weights;
  start_motion_.noalias() -= motion_steps_.leftCols(stored_) * weights;
}

}  // namespace ricochet
