#include "ricochet/problem/rigid_motion.hpp"

#include <Eigen/Dense>

namespace ricochet {

RigidMotion::RigidMotion(const Points& nodes, const SparseMatrix& stiffness)
    : dimension_(static_cast<int>(nodes.rows())), positions_(nodes) {
  const Index d = nodes.rows();
  std::vector<char> seen(static_cast<std::size_t>(nodes.cols()), 0);
  for (Index first = 0; first < nodes.cols(); ++first) {
    if (seen[static_cast<std::size_t>(first)] != 0) continue;
    Body body;
    body.nodes.push_back(first);
    seen[static_cast<std::size_t>(first)] = 1;
    for (std::size_t k = 0; k < body.nodes.size(); ++k) {
      for (SparseMatrix::InnerIterator entry(stiffness, body.nodes[k] * d); entry; ++entry) {
        const auto neighbour = static_cast<Index>(entry.row()) / d;
        if (seen[static_cast<std::size_t>(neighbour)] != 0) continue;
        seen[static_cast<std::size_t>(neighbour)] = 1;
        body.nodes.push_back(neighbour);
      }
    }
    Vector centre = Vector::Zero(d);
    for (const Index node : body.nodes) centre += nodes.col(node);
    centre /= static_cast<double>(body.nodes.size());
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const Index node : body.nodes) {
      positions_.col(node) -= centre;
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      x.head(d) = positions_.col(node);
      inertia += x.squaredNorm() * Eigen::Matrix3d::Identity() - x * x.transpose();
    }
    body.inverse_inertia = d == 2 ? Matrix::Constant(1, 1, 1.0 / inertia(2, 2)) : Matrix(inertia.inverse());
    if (!body.inverse_inertia.allFinite()) body.inverse_inertia.setZero();
    bodies_.push_back(std::move(body));
  }
}

void RigidMotion::remove(const Vector& displacement, Vector& deformation) const {
  dimension_ == 2 ? remove_in<2>(displacement, deformation) : remove_in<3>(displacement, deformation);
}

template <int d>
void RigidMotion::remove_in(const Vector& displacement, Vector& deformation) const {
  using Point = Eigen::Matrix<double, d, 1>;
  deformation.resize(displacement.size());
  const auto part = [](const Point& x, const Point& u) {  // x × u
    if constexpr (d == 2) {
      return Eigen::Matrix<double, 1, 1>(x[0] * u[1] - x[1] * u[0]);
    } else {
      return Eigen::Vector3d(x.cross(u));
    }
  };
  for (const Body& body : bodies_) {
    Point mean = Point::Zero();
    for (const Index node : body.nodes) mean += displacement.segment<d>(node * d);
    mean /= static_cast<double>(body.nodes.size());
    Eigen::Matrix<double, d == 2 ? 1 : 3, 1> moment;
    moment.setZero();
    for (const Index node : body.nodes) {
      moment += part(positions_.col(node).head<d>(), displacement.segment<d>(node * d) - mean);
    }
    const Eigen::Matrix<double, d == 2 ? 1 : 3, 1> rotation = body.inverse_inertia * moment;
    for (const Index node : body.nodes) {
      const Point x = positions_.col(node).head<d>();
      Point turned;
      if constexpr (d == 2) {
        turned << -rotation[0] * x[1], rotation[0] * x[0];
      } else {
        turned = rotation.cross(x);
      }
      deformation.segment<d>(node * d) = displacement.segment<d>(node * d) - mean - turned;
    }
  }
}

}  // namespace ricochet
