#include "ricochet/problem/body_rotations.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

namespace {

/// The orthogonal factor of a matrix with a positive determinant, by Newton's iteration R ← ½(R + R⁻ᵀ) (N. J. Higham,
/// SIAM J. Sci. Stat. Comput. 7 (1986) 1160–1174). A matrix that has none to speak of gives I.
Tensor orthogonal_factor(Tensor matrix) {
  constexpr int most_steps = 60;
  const double size = matrix.norm();
  if (!(matrix.determinant() > 1e-12 * size * size * size)) return Tensor::Identity();
  for (int step = 0; step < most_steps; ++step) {
    const Tensor next = 0.5 * (matrix + matrix.inverse().transpose());
    const double change = (next - matrix).norm();
    matrix = next;
    if (change < 1e-14) break;
  }
  return matrix;
}

}  // namespace

BodyRotations::BodyRotations(const SemidiscreteProblem& problem)
    : problem_(problem),
      body_of_node_(static_cast<std::size_t>(problem.nodes.cols()), -1),
      is_contact_(static_cast<std::size_t>(problem.nodes.cols()), 0) {
  const int d = problem.dimension;
  for (const Index dof : problem.contact_dofs) is_contact_[static_cast<std::size_t>(dof / d)] = 1;
  for (const std::vector<Index>& members : graph_components(problem.internal_force->tangent(), d)) {
    if (members.size() == 1 && problem.is_tied_dof(members.front() * d)) continue;
    Body body;
    std::array<bool, 3> held{};
    for (const Index node : members) {
      for (int k = 0; k < d; ++k) held[static_cast<std::size_t>(k)] |= problem.supports.contains(node * d + k);
    }
    const auto count = std::count(held.begin(), held.end(), true);
    if (count == 1 && d == 3) body.axis = static_cast<int>(std::find(held.begin(), held.end(), true) - held.begin());
    for (const Index node : members) body_of_node_[static_cast<std::size_t>(node)] = static_cast<int>(bodies_.size());
    if (!problem.axisymmetric && (count == 0 || body.axis >= 0)) {
      const auto size = static_cast<Index>(members.size());
      const Index stride = std::max(Index{1}, size / most_fitted);
      for (Index i = 0; i < size; i += stride) body.fitted.push_back(members[static_cast<std::size_t>(i)]);
    }
    body.members = members;
    bodies_.push_back(std::move(body));
  }
}

template <int d>
Tensor BodyRotations::fit_body(const Body& body, const Vector& displacement) const {
  using Place = Eigen::Matrix<double, d, 1>;
  Place centre = Place::Zero(), now = Place::Zero();
  for (const Index node : body.fitted) {
    const Place place = problem_.nodes.col(node);
    centre += place;
    now += place + displacement.segment<d>(node * d);
  }
  centre /= static_cast<double>(body.fitted.size());
  now /= static_cast<double>(body.fitted.size());
  Eigen::Matrix<double, d, d> sum = Eigen::Matrix<double, d, d>::Zero();
  for (const Index node : body.fitted) {
    const Place place = problem_.nodes.col(node);
    sum += (place + displacement.segment<d>(node * d) - now) * (place - centre).transpose();
  }
  Tensor rotation = Tensor::Identity();
  if (d == 2 || body.axis >= 0) {
    // About z of the plane, or about an axis in space: the angle of the two components across it.
    const int i = d == 2 ? 0 : (body.axis + 1) % 3, j = d == 2 ? 1 : (body.axis + 2) % 3;
    const double cosine = sum(i, i) + sum(j, j), sine = sum(j, i) - sum(i, j), size = std::hypot(cosine, sine);
    if (!(size > 0.0)) return rotation;
    rotation(i, i) = rotation(j, j) = cosine / size;
    rotation(j, i) = sine / size;
    rotation(i, j) = -sine / size;
  } else {
    Tensor all = Tensor::Identity();
    all.topLeftCorner<d, d>() = sum / sum.norm();
    rotation = orthogonal_factor(all);
  }
  return rotation.allFinite() ? rotation : Tensor::Identity();
}

void BodyRotations::fit(const Vector& displacement, std::vector<Tensor>& rotations) const {
  rotations.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].fitted.empty()) {
      rotations[i].setIdentity();
    } else {
      rotations[i] =
          problem_.dimension == 2 ? fit_body<2>(bodies_[i], displacement) : fit_body<3>(bodies_[i], displacement);
    }
  }
}

Eigen::Vector3d BodyRotations::place(Index node, const Vector& displacement) const {
  const Index d = problem_.dimension;
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(d) = problem_.nodes.col(node) + displacement.segment(node * d, d);
  return result;
}

BodyRotations::Flight BodyRotations::fit_flight(const Body& body, const Vector& displacement,
                                                const Vector& velocity) const {
  const Index d = problem_.dimension;
  Flight flight;
  double count = 0.0;
  for (const Index node : body.fitted) {
    if (is_contact_[static_cast<std::size_t>(node)] != 0) continue;
    flight.centre += place(node, displacement);
    flight.velocity.head(d) += velocity.segment(node * d, d);
    count += 1.0;
  }
  if (count == 0.0) return flight;
  flight.centre /= count;
  flight.velocity /= count;
  Tensor inertia = Tensor::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const Index node : body.fitted) {
    if (is_contact_[static_cast<std::size_t>(node)] != 0) continue;
    const Eigen::Vector3d arm = place(node, displacement) - flight.centre;
    Eigen::Vector3d relative = -flight.velocity;
    relative.head(d) += velocity.segment(node * d, d);
    inertia += arm.squaredNorm() * Tensor::Identity() - arm * arm.transpose();
    moment += arm.cross(relative);
  }
  if (d == 2 || body.axis >= 0) {
    const int axis = d == 2 ? 2 : body.axis;
    flight.spin[axis] = moment[axis] / inertia(axis, axis);
  } else {
    flight.spin = inertia.inverse() * moment;
  }
  if (!flight.spin.allFinite()) flight.spin.setZero();
  return flight;
}

void BodyRotations::predict(const Vector& displacement, const Vector& velocity, double step, Vector& end) const {
  end = displacement + step * velocity;
  const Index d = problem_.dimension;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    if (body.fitted.empty()) continue;
    const Flight flight = fit_flight(body, displacement, velocity);
    const double angle = 2.0 * std::atan(0.5 * step * flight.spin.norm());
    if (angle == 0.0) continue;
    const Tensor rotation = Eigen::AngleAxisd(angle, flight.spin.normalized()).toRotationMatrix();
    for (const Index node : body.members) {
      const Eigen::Vector3d arm = place(node, displacement) - flight.centre;
      Eigen::Vector3d straight = Eigen::Vector3d::Zero();  // w
      if (is_contact_[static_cast<std::size_t>(node)] == 0) {
        straight.head(d) = velocity.segment(node * d, d);
        straight -= flight.velocity + flight.spin.cross(arm);
      }
      const Eigen::Vector3d now = rotation * (arm + step * straight) + flight.centre + step * flight.velocity;
      end.segment(node * d, d) = now.head(d) - problem_.nodes.col(node);
    }
  }
}

double rotation_angle(const Tensor& rotation) {
  // Half of the antisymmetric part has the sine of the angle, the trace its cosine.
  const Eigen::Vector3d axis(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                             rotation(1, 0) - rotation(0, 1));
  return std::atan2(0.5 * axis.norm(), 0.5 * (rotation.trace() - 1.0));
}

}  // namespace ricochet
