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
    body.centre = Vector::Zero(d);
    for (const Index node : body.nodes) body.centre += nodes.col(node);
    body.centre /= static_cast<double>(body.nodes.size());
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const Index node : body.nodes) {
      positions_.col(node) -= body.centre;
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
  const int d = dimension_;
  deformation.resize(displacement.size());
  for (const Body& body : bodies_) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Index node : body.nodes) mean.head(d) += displacement.segment(node * d, d);
    mean /= static_cast<double>(body.nodes.size());
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    for (const Index node : body.nodes) {
      x.head(d) = positions_.col(node);
      u.head(d) = displacement.segment(node * d, d) - mean.head(d);
      moment += x.cross(u);
    }
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
    if (d == 2) {
      rotation[2] = body.inverse_inertia(0, 0) * moment[2];
    } else {
      rotation = body.inverse_inertia * moment;
    }
    for (const Index node : body.nodes) {
      x.head(d) = positions_.col(node);
      deformation.segment(node * d, d) = displacement.segment(node * d, d) - mean.head(d) - rotation.cross(x).head(d);
    }
  }
}

}  // namespace ricochet
