#include "ricochet/problem/body_rotations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/linear_algebra/graph_components.hpp"
#include "ricochet/linear_algebra/orthogonal_factor.hpp"

namespace ricochet {

BodyRotations::BodyRotations(const SemidiscreteProblem& problem)
    : problem_(problem), body_of_node_(std::size_t(problem.nodes.cols()), -1) {
  const int d = problem.dimension;
  for (const std::vector<Index>& members : graph_components(problem.internal_force->graph(d))) {
    if (members.size() == 1 && problem.is_tied_dof(members.front() * d)) continue;
    if (problem.is_of_free_body(members.front())) continue;
    Body body;
    std::array<bool, 3> supported{};
    for (const Index node : members) {
      for (int k = 0; k < d; ++k) supported[std::size_t(k)] |= problem.supports.contains(node * d + k);
    }
    const auto count = std::ranges::count(supported, true);
    body.is_held = count > 0;
    if (count == 1 && d == 3) body.axis = int(std::ranges::find(supported, true) - supported.begin());
    for (const Index node : members) body_of_node_[std::size_t(node)] = int(bodies_.size());
    if (!problem.axisymmetric && (count == 0 || body.axis >= 0)) {
      const auto size = Index(members.size());
      const Index stride = std::max(Index{1}, size / most_fitted);
      for (Index i = 0; i < size; i += stride) body.fitted.push_back(members[std::size_t(i)]);
    }
    bodies_.push_back(std::move(body));
  }
}

template <int d>
Tensor BodyRotations::fit_body(const Body& body, const Vector& displacement) const {
  using Position = Eigen::Matrix<double, d, 1>;
  Position centre = Position::Zero(), now = Position::Zero();
  for (const Index node : body.fitted) {
    const Position position = problem_.nodes.col(node);
    centre += position;
    now += position + displacement.segment<d>(node * d);
  }
  centre /= double(body.fitted.size());
  now /= double(body.fitted.size());
  Eigen::Matrix<double, d, d> sum = Eigen::Matrix<double, d, d>::Zero();
  for (const Index node : body.fitted) {
    const Position position = problem_.nodes.col(node);
    sum += (position + displacement.segment<d>(node * d) - now) * (position - centre).transpose();
  }
  Tensor rotation = Tensor::Identity();
  if (d == 2 || body.axis >= 0) {
    // About z in 2D, or about an axis in 3D: the angle follows from the two components normal to it.
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

double rotation_angle(const Tensor& rotation) {
  // Half of the antisymmetric part gives the sine of the angle, the trace gives its cosine.
  const Eigen::Vector3d axis(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                             rotation(1, 0) - rotation(0, 1));
  return std::atan2(0.5 * axis.norm(), 0.5 * (rotation.trace() - 1.0));
}

}  // namespace ricochet
