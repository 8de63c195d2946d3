#include "ricochet/problem/rigid_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

/// x × u: one number in 2D, three in 3D.
template <int d>
using Axial = Eigen::Matrix<double, d == 2 ? 1 : 3, 1>;

template <int d, class Position, class Displacement>
Axial<d> cross(const Position& x, const Displacement& u) {
  if constexpr (d == 2) {
    return Axial<d>(x[0] * u[1] - x[1] * u[0]);
  } else {
    return Axial<d>(x[1] * u[2] - x[2] * u[1], x[2] * u[0] - x[0] * u[2], x[0] * u[1] - x[1] * u[0]);
  }
}

/// Σ u and Σ x × u.
template <int d>
struct Sums {
  Eigen::Matrix<double, d, 1> displacement = Eigen::Matrix<double, d, 1>::Zero();
  Axial<d> moment = Axial<d>::Zero();
  Sums& operator+=(const Sums& other) {
    displacement += other.displacement;
    moment += other.moment;
    return *this;
  }
};

}  // namespace

RigidMotion::RigidMotion(const Points& nodes, const SparseMatrix& stiffness)
    : dimension_(static_cast<int>(nodes.rows())), positions_(nodes) {
  const Index d = nodes.rows();
  std::vector<int> body_of_node(static_cast<std::size_t>(nodes.cols()), -1);
  for (Index first = 0; first < nodes.cols(); ++first) {
    if (body_of_node[static_cast<std::size_t>(first)] >= 0) continue;
    const int number = static_cast<int>(bodies_.size());
    Body body;
    body.nodes.push_back(first);
    body_of_node[static_cast<std::size_t>(first)] = number;
    for (std::size_t k = 0; k < body.nodes.size(); ++k) {
      for (SparseMatrix::InnerIterator entry(stiffness, body.nodes[k] * d); entry; ++entry) {
        const auto neighbour = static_cast<Index>(entry.row()) / d;
        if (body_of_node[static_cast<std::size_t>(neighbour)] >= 0) continue;
        body_of_node[static_cast<std::size_t>(neighbour)] = number;
        body.nodes.push_back(neighbour);
      }
    }
    std::sort(body.nodes.begin(), body.nodes.end());
    body.count = static_cast<Index>(body.nodes.size());
    Vector centre = Vector::Zero(d);
    for (const Index node : body.nodes) centre += nodes.col(node);
    centre /= static_cast<double>(body.count);
    body.position_sum = Vector::Zero(d);
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const Index node : body.nodes) {
      positions_.col(node) -= centre;
      body.position_sum += positions_.col(node);
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      x.head(d) = positions_.col(node);
      inertia += x.squaredNorm() * Eigen::Matrix3d::Identity() - x * x.transpose();
    }
    body.inverse_inertia = d == 2 ? Matrix::Constant(1, 1, 1.0 / inertia(2, 2)) : Matrix(inertia.inverse());
    if (!body.inverse_inertia.allFinite()) body.inverse_inertia.setZero();
    if (body.count == nodes.cols()) body.nodes = {};
    bodies_.push_back(std::move(body));
  }
  if (bodies_.size() > 1) body_of_node_ = std::move(body_of_node);
  motions_.resize(bodies_.size());
}

template <int d>
void RigidMotion::fit(const Vector& displacement) const {
  for (std::size_t number = 0; number < bodies_.size(); ++number) {
    const Body& body = bodies_[number];
    const auto sums = parallel_sum<Sums<d>>(body.count, [&](Index first, Index last) {
      Sums<d> part;
      for (Index i = first; i < last; ++i) {
        const Index node = body.nodes.empty() ? i : body.nodes[static_cast<std::size_t>(i)];
        const Eigen::Matrix<double, d, 1> u = displacement.segment<d>(node * d);
        part.displacement += u;
        part.moment += cross<d>(positions_.col(node), u);
      }
      return part;
    });
    const Eigen::Matrix<double, d, 1> mean = sums.displacement / static_cast<double>(body.count);
    // Σ x × (u − mean).
    const Axial<d> moment = sums.moment - cross<d>(body.position_sum, mean);
    Motion& motion = motions_[number];
    motion.translation.template head<d>() = mean;
    motion.rotation.template tail<d == 2 ? 1 : 3>() = body.inverse_inertia.template topLeftCorner < d == 2 ? 1 : 3,
                                               d == 2 ? 1 : 3 > () * moment;
  }
}

template <int d, class NodeAt>
void RigidMotion::remove_in(const Vector& displacement, const NodeAt& node_at, Vector& deformation) const {
  fit<d>(displacement);
  deformation.resize(displacement.size());
  parallel_ranges(positions_.cols(), [&](Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      const Index node = node_at(i);
      const Motion& motion =
          motions_[body_of_node_.empty() ? 0 : static_cast<std::size_t>(body_of_node_[static_cast<std::size_t>(node)])];
      const Eigen::Matrix<double, d, 1> x = positions_.col(node).template head<d>();
      Eigen::Matrix<double, d, 1> turned;
      if constexpr (d == 2) {
        turned << -motion.rotation[2] * x[1], motion.rotation[2] * x[0];
      } else {
        turned = motion.rotation.cross(x);
      }
      deformation.segment<d>(i * d) =
          displacement.segment<d>(node * d) - motion.translation.template head<d>() - turned;
    }
  });
}

void RigidMotion::remove(const Vector& displacement, Vector& deformation) const {
  const auto itself = [](Index i) { return i; };
  dimension_ == 2 ? remove_in<2>(displacement, itself, deformation) : remove_in<3>(displacement, itself, deformation);
}

void RigidMotion::remove(const Vector& displacement, const NodeOrder& order, Vector& deformation) const {
  const auto ordered = [&](Index i) { return Index{order.node[static_cast<std::size_t>(i)]}; };
  dimension_ == 2 ? remove_in<2>(displacement, ordered, deformation) : remove_in<3>(displacement, ordered, deformation);
}

}  // namespace ricochet
