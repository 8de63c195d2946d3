#include "ricochet/problem/rigid_motion.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

namespace {

/// Type of x × u: one number in 2D, three in 3D.
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

/// Returns the k-th of `count` indices, scattered by multiples of the golden ratio, so that the sample shares no
/// pattern with a structured mesh.
std::size_t scattered(std::uint64_t k, std::size_t count) {
  const std::uint64_t fraction = (k * 2654435769u) & 0xffffffffu;
  return std::size_t((fraction * count) >> 32);
}

/// Displacement of an infinitesimal rotation of all positions about an axis by the angle 1.
Vector rotation_about(Index axis, const Points& positions) {
  const Index d = positions.rows();
  Vector result(positions.size());
  for (Index i = 0; i < positions.cols(); ++i) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    x.head(d) = positions.col(i);
    result.segment(i * d, d) = Eigen::Vector3d::Unit(axis).cross(x).head(d);
  }
  return result;
}

}  // namespace

RigidMotion::RigidMotion(const Points& nodes, const SparseMatrix& stiffness)
    : dimension_(int(nodes.rows())), positions_(nodes.rows(), nodes.cols()) {
  find_bodies(nodes, stiffness);
  select_rotations_that_strain(stiffness);
  if (dimension_ == 2) select_translations_that_strain(stiffness);
  motions_.resize(bodies_.size());
}

/// Fills bodies_, positions_ and body_of_node_.
void RigidMotion::find_bodies(const Points& nodes, const SparseMatrix& stiffness) {
  std::vector<std::vector<Index>> components = graph_components(MatrixGraph(stiffness, int(nodes.rows())));
  if (components.size() > 1) body_of_node_.resize(std::size_t(nodes.cols()));
  for (std::vector<Index>& members : components) {
    std::ranges::sort(members);
    const auto number = int(bodies_.size());
    bodies_.push_back(make_body(nodes, members));
    for (const Index node : members) {
      positions_.col(node) = nodes.col(node) - bodies_.back().centre;
      if (components.size() > 1) body_of_node_[std::size_t(node)] = number;
    }
  }
}

RigidMotion::Body RigidMotion::make_body(const Points& nodes, const std::vector<Index>& members) {
  const Index d = nodes.rows();
  Body body;
  const bool all = Index(members.size()) <= most_fitted;
  const std::size_t fitted = all ? members.size() : std::size_t(most_fitted);
  for (std::size_t k = 0; k < fitted; ++k) body.fitted.push_back(int(members[all ? k : scattered(k, members.size())]));
  const auto count = Index(body.fitted.size());
  body.positions.resize(d, count);
  for (Index i = 0; i < count; ++i) body.positions.col(i) = nodes.col(body.fitted[std::size_t(i)]);
  body.centre = body.positions.rowwise().mean();
  body.positions.colwise() -= body.centre;
  body.position_sum = body.positions.rowwise().sum();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < count; ++i) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    x.head(d) = body.positions.col(i);
    inertia += x.squaredNorm() * Eigen::Matrix3d::Identity() - x * x.transpose();
  }
  body.inverse_inertia = d == 2 ? Matrix::Constant(1, 1, 1.0 / inertia(2, 2)) : Matrix(inertia.inverse());
  if (!body.inverse_inertia.allFinite()) body.inverse_inertia.setZero();
  return body;
}

std::size_t RigidMotion::body_of(std::size_t node) const {
  return body_of_node_.empty() ? 0 : std::size_t(body_of_node_[node]);
}

std::vector<char> RigidMotion::strained_by(const Vector& motion, const SparseMatrix& stiffness) const {
  constexpr double rounding = 1e-9;
  const Index d = dimension_;
  std::vector<char> strained(static_cast<std::size_t>(positions_.cols()), 0);
  parallel_ranges(positions_.cols(), [&](Index first, Index last) {
    for (Index dof = first * d; dof < last * d; ++dof) {
      double force = 0.0, terms = 0.0;
      for (SparseMatrix::InnerIterator entry(stiffness, dof); entry; ++entry) {
        force += entry.value() * motion[entry.row()];
        terms += std::abs(entry.value() * motion[entry.row()]);
      }
      if (std::abs(force) > rounding * terms) strained[std::size_t(dof / d)] = 1;
    }
  });
  return strained;
}

/// Linear functions on curved cells do not contain rotations: K R is not zero for them, and removing R would alter K U.
void RigidMotion::select_rotations_that_strain(const SparseMatrix& stiffness) {
  for (Index axis = dimension_ == 2 ? 2 : 0; axis < 3; ++axis) {
    const std::vector<char> strained = strained_by(rotation_about(axis, positions_), stiffness);
    for (std::size_t node = 0; node < strained.size(); ++node) {
      if (strained[node] != 0) bodies_[body_of(node)].inverse_inertia.setZero();
    }
  }
}

/// An axisymmetric body is strained by a translation away from its axis.
void RigidMotion::select_translations_that_strain(const SparseMatrix& stiffness) {
  Vector across = Vector::Zero(positions_.size());
  for (Index node = 0; node < positions_.cols(); ++node) across[node * dimension_] = 1.0;
  const std::vector<char> strained = strained_by(across, stiffness);
  for (std::size_t node = 0; node < strained.size(); ++node) {
    if (strained[node] != 0) bodies_[body_of(node)].moves_across = false;
  }
}

template <int d>
RigidMotion::Motion RigidMotion::fit(const Body& body, const Vector& displacement) const {
  constexpr int rotations = d == 2 ? 1 : 3;
  Eigen::Matrix<double, d, 1> sum = Eigen::Matrix<double, d, 1>::Zero();
  Axial<d> moment = Axial<d>::Zero();
  for (std::size_t i = 0; i < body.fitted.size(); ++i) {
    const Eigen::Matrix<double, d, 1> u = displacement.segment<d>(Index{body.fitted[i]} * d);
    sum += u;
    moment += cross<d>(body.positions.col(Index(i)), u);
  }
  const Eigen::Matrix<double, d, 1> mean = sum / double(body.fitted.size());
  moment -= cross<d>(body.position_sum, mean);  // Σ x × (u − mean)
  Motion motion;
  motion.translation.template head<d>() = mean;
  if (!body.moves_across) motion.translation[0] = 0.0;
  motion.rotation.template tail<rotations>() =
      body.inverse_inertia.template topLeftCorner<rotations, rotations>() * moment;
  return motion;
}

template <int d>
void RigidMotion::fit_bodies(const Vector& displacement) const {
  for (std::size_t number = 0; number < bodies_.size(); ++number) {
    motions_[number] = fit<d>(bodies_[number], displacement);
  }
}

/// Rigid part of the displacement of the last fit.
template <int d>
Eigen::Matrix<double, d, 1> RigidMotion::rigid_part(Index node) const {
  const Motion& motion = motions_[body_of(std::size_t(node))];
  const Eigen::Matrix<double, d, 1> x = positions_.col(node).template head<d>();
  Eigen::Matrix<double, d, 1> rotational;
  if constexpr (d == 2) {
    rotational << -motion.rotation[2] * x[1], motion.rotation[2] * x[0];
  } else {
    rotational = motion.rotation.cross(x);
  }
  return motion.translation.template head<d>() + rotational;
}

template <int d>
void RigidMotion::remove_in(const Vector& displacement, Vector& deformation) const {
  fit_bodies<d>(displacement);
  deformation.resize(displacement.size());
  parallel_ranges(positions_.cols(), [&](Index first, Index last) {
    for (Index i = first; i < last; ++i)
      deformation.segment<d>(i * d) = displacement.segment<d>(i * d) - rigid_part<d>(i);
  });
}

template <int d>
double RigidMotion::work_in(const Vector& force, const Vector& displacement) const {
  fit_bodies<d>(displacement);
  return parallel_sum<double>(positions_.cols(), [&](Index first, Index last) {
    double sum = 0.0;
    for (Index i = first; i < last; ++i)
      sum += force.segment<d>(i * d).dot(displacement.segment<d>(i * d) - rigid_part<d>(i));
    return sum;
  });
}

void RigidMotion::remove(const Vector& displacement, Vector& deformation) const {
  dimension_ == 2 ? remove_in<2>(displacement, deformation) : remove_in<3>(displacement, deformation);
}

double RigidMotion::work(const Vector& force, const Vector& displacement) const {
  return dimension_ == 2 ? work_in<2>(force, displacement) : work_in<3>(force, displacement);
}

}  // namespace ricochet
