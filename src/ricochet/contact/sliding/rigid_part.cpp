#include "ricochet/contact/sliding/rigid_part.hpp"

#include <Eigen/LU>

namespace ricochet {

namespace {

using Places = std::vector<Eigen::Vector3d>;

/// Inertia, relative to the trace, below which it is rounding error: collinear points have no moment of inertia about
/// their line, and no motion has angular momentum about it.
constexpr double least_inertia = 1e-13;

Eigen::Vector3d mean_of(const Places& values) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Returns ω with I ω = momentum, I the inertia of unit masses at the points about their middle.
Eigen::Vector3d rotation_of(const Places& places, const Eigen::Vector3d& middle, bool plane,
                            const Eigen::Vector3d& momentum) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Vector3d arm = place - middle;
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
  for (int round = 0; round < 2; ++round) result += solver.solve(momentum - inertia * result);
  return result;
}

Eigen::Vector3d momentum_of(const Places& places, const Eigen::Vector3d& middle, const Places& motions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < places.size(); ++k) sum += (places[k] - middle).cross(motions[k]);
  return sum;
}

}  // namespace

void remove_rigid_part(const Places& places, bool plane, Places& motions) {
  if (places.empty()) return;
  const Eigen::Vector3d middle = mean_of(places), drift = mean_of(motions);
  for (Eigen::Vector3d& motion : motions) motion -= drift;
  // The second pass removes the rounding error of the first.
  for (int round = 0; round < 2; ++round) {
    const Eigen::Vector3d rotation = rotation_of(places, middle, plane, momentum_of(places, middle, motions));
    for (std::size_t k = 0; k < places.size(); ++k) motions[k] -= rotation.cross(places[k] - middle);
  }
}

void forces_of_couple(const Places& places, bool plane, const Eigen::Vector3d& moment, Places& forces) {
  forces.assign(places.size(), Eigen::Vector3d::Zero());
  if (places.empty()) return;
  const Eigen::Vector3d middle = mean_of(places), rotation = rotation_of(places, middle, plane, moment);
  for (std::size_t k = 0; k < places.size(); ++k) forces[k] = rotation.cross(places[k] - middle);
}

}  // namespace ricochet
