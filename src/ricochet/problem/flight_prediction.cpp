#include "ricochet/problem/flight_prediction.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace ricochet {

FlightPrediction::FlightPrediction(const SemidiscreteProblem& problem) : problem_(problem), bodies_(problem) {
  const Index d = problem.dimension;
  positions_.setZero(problem.dof_count());
  for (Index node = 0; node < problem.nodes.cols(); ++node) positions_[node * d] = 1.0;
  problem.mass.multiply(positions_, momentum_);
  node_mass_.resize(problem.nodes.cols());
  for (Index node = 0; node < problem.nodes.cols(); ++node) node_mass_[node] = momentum_[node * d];
}

Eigen::Vector3d FlightPrediction::at(const Vector& values, Index node) const {
  const Index d = problem_.dimension;
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (Index k = 0; k < d; ++k) result[k] = values[node * d + k];
  return result;
}

bool FlightPrediction::has_inertia(Index node) const {
  for (Index k = 0; k < problem_.dimension; ++k) {
    if (problem_.is_massless[std::size_t(node * problem_.dimension + k)] != 0) return false;
  }
  return true;
}

/// Calls visit(node, flight) for all nodes of bodies that rotate.
template <class Visit>
void FlightPrediction::visit_nodes(const Visit& visit) const {
  for (Index node = 0; node < problem_.nodes.cols(); ++node) {
    const int body = bodies_.body_of_node(node);
    if (body >= 0 && bodies_.rotates(body)) visit(node, std::size_t(body));
  }
}

void FlightPrediction::fit(const Vector& displacement, const Vector& velocity, double step) {
  positions_ = displacement + problem_.nodes.reshaped();
  problem_.mass.multiply(positions_, first_moment_);
  problem_.mass.multiply(velocity, momentum_);
  flights_.assign(bodies_.count(), {});
  visit_nodes([&](Index node, std::size_t body) {
    Flight& flight = flights_[body];
    flight.mass += node_mass_[node];
    flight.centre += at(first_moment_, node);
    flight.velocity += at(momentum_, node);
  });
  for (Flight& flight : flights_) {
    flight.centre /= flight.mass;
    flight.velocity /= flight.mass;
  }
  visit_nodes([&](Index node, std::size_t body) {
    Flight& flight = flights_[body];
    const Eigen::Vector3d arm = at(positions_, node) - flight.centre;
    flight.spread += arm * (at(first_moment_, node) - node_mass_[node] * flight.centre).transpose();
    flight.momentum += arm.cross(at(momentum_, node));
  });
  for (std::size_t body = 0; body < flights_.size(); ++body) {
    Flight& flight = flights_[body];
    const int axis = bodies_.axis(int(body));
    const Tensor inertia =
        flight.spread.trace() * Tensor::Identity() - 0.5 * (flight.spread + flight.spread.transpose());
    if (axis >= 0) {
      flight.spin[axis] = flight.momentum[axis] / inertia(axis, axis);
    } else {
      flight.spin = inertia.inverse() * flight.momentum;
    }
    const double angle = 2.0 * std::atan(0.5 * step * flight.spin.norm());
    if (angle > 0.0) flight.rotation = Eigen::AngleAxisd(angle, flight.spin.normalized()).toRotationMatrix();
    if (flight.rotation.allFinite() && flight.spin.allFinite() && flight.centre.allFinite()) continue;
    flight.spin.setZero();
    flight.rotation.setIdentity();
  }
}

void FlightPrediction::predict(const Vector& displacement, const Vector& velocity, double step, Vector& end) {
  fit(displacement, velocity, step);
  end = displacement + step * velocity;
  const Index d = problem_.dimension;
  visit_nodes([&](Index node, std::size_t body) {
    const Flight& flight = flights_[body];
    if (flight.spin.isZero(0.0)) return;
    const Eigen::Vector3d arm = at(positions_, node) - flight.centre;
    Eigen::Vector3d straight = Eigen::Vector3d::Zero();  // w
    if (has_inertia(node)) straight = at(velocity, node) - flight.velocity - flight.spin.cross(arm);
    const Eigen::Vector3d change = flight.rotation * (arm + step * straight) - arm + step * flight.velocity;
    end.segment(node * d, d) = displacement.segment(node * d, d) + change.head(d);
  });
}

}  // namespace ricochet
