#include "ricochet/contact/sliding/rigid_part.hpp"

#include <Eigen/LU>

namespace ricochet {

namespace {

using Vectors = std::vector<Eigen::Vector3d>;

/// Inertia, relative to the trace, below which it is rounding error: collinear points have no moment of inertia about
/// their line, and no motion has angular momentum about it.
constexpr double least_inertia = 1e-13;

Eigen::Vector3d mean_of(const Vectors& values) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& value : values) sum += value;
  return sum / double(values.size());
}

/// Returns ω with I ω = momentum, I the inertia of unit masses at the points about their middle.
Eigen::Vector3d rotation_of(const Vectors& positions, const Eigen::Vector3d& middle, bool plane,
                            const Eigen::Vector3d& momentum) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& position : positions) {
    const Eigen::Vector3d arm = position - middle;
    inertia += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
  }
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  if (plane) {
    if (inertia(2, 2) > 0.0) result[2] = momentum[2] / inertia(2, 2);
    return result;
  }
  if (!(inertia.trace() > 0.0)) return result;
  Eigen::Matrix3d definite = inertia;
  definite.diagonal().array() += least_inertia * inertia.trace();
  const Eigen::PartialPivLU<Eigen::Matrix3d> solver(definite);
  // The second iteration corrects for the regularization.
  for (int iteration = 0; iteration < 2; ++iteration) result += solver.solve(momentum - inertia * result);
  return result;
}

Eigen::Vector3d momentum_of(const Vectors& positions, const Eigen::Vector3d& middle, const Vectors& motions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < positions.size(); ++k) sum += (positions[k] - middle).cross(motions[k]);
  return sum;
}

}  // namespace

void remove_rigid_part(const Vectors& positions, bool plane, Vectors& motions) {
  if (positions.empty()) return;
  const Eigen::Vector3d middle = mean_of(positions), drift = mean_of(motions);
  for (Eigen::Vector3d& motion : motions) motion -= drift;
  // The second pass removes the rounding error of the first.
  for (int iteration = 0; iteration < 2; ++iteration) {
    const Eigen::Vector3d rotation = rotation_of(positions, middle, plane, momentum_of(positions, middle, motions));
    for (std::size_t k = 0; k < positions.size(); ++k) motions[k] -= rotation.cross(positions[k] - middle);
  }
}

void forces_of_couple(const Vectors& positions, bool plane, const Eigen::Vector3d& moment, Vectors& forces) {
  forces.assign(positions.size(), Eigen::Vector3d::Zero());
  if (positions.empty()) return;
  const Eigen::Vector3d middle = mean_of(positions), rotation = rotation_of(positions, middle, plane, moment);
  for (std::size_t k = 0; k < positions.size(); ++k) forces[k] = rotation.cross(positions[k] - middle);
}

}  // namespace ricochet
