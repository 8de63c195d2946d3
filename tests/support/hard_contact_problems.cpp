#include "support/hard_contact_problems.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace ricochet::test_support {
namespace {

/// Projects on |r_T| ≤ F r_N.
Eigen::Vector3<long double> project_long(long double friction, const Eigen::Vector3<long double>& r) {
  const long double length = r.tail<2>().norm();
  if (friction * length <= -r[0]) return Eigen::Vector3<long double>::Zero();
  if (length <= friction * r[0]) return r;
  Eigen::Vector3<long double> result = r;
  result[0] = (r[0] + friction * length) / (1 + friction * friction);
  if (length > 0) result.tail<2>() *= friction * result[0] / length;
  return result;
}

}  // namespace

Matrix rigid_trace(const std::vector<RigidPoint>& points, Index dimension) {
  const std::vector<Index> plane{0, 2, 4};
  const auto count = Index(points.size());
  Matrix trace(dimension * count, dimension == 2 ? 3 : 6);
  for (Index i = 0; i < count; ++i) {
    const auto& [place, normal] = points[std::size_t(i)];
    // An axis not parallel to the normal; in two dimensions the tangent lies in the plane.
    const Eigen::Vector3d across = std::abs(normal.y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d first = across.cross(normal).normalized(), second = normal.cross(first);
    const std::array<Eigen::Vector3d, 3> axes{normal, first, second};
    for (Index k = 0; k < dimension; ++k) {
      const Eigen::Vector3d& axis = axes[std::size_t(k)];
      Eigen::Matrix<double, 1, 6> row;
      row << axis.transpose(), place.cross(axis).transpose();
      if (dimension == 2) {
        trace.row(dimension * i + k) = row(0, plane);
      } else {
        trace.row(dimension * i + k) = row;
      }
    }
  }
  return trace;
}

FrictionProblem rigid_problem(const std::vector<RigidPoint>& points, const Eigen::Vector3d& sides,
                              const Eigen::Matrix<double, 6, 1>& velocity, Index dimension, double friction) {
  FrictionProblem problem(std::vector<Index>(points.size(), dimension), friction);
  const Matrix trace = rigid_trace(points, dimension);
  const std::vector<Index> plane{0, 2, 4};
  Vector inverse_mass = Vector::Ones(6);
  for (Index k = 0; k < 3; ++k) inverse_mass[3 + k] = 12.0 / (sides.squaredNorm() - sides[k] * sides[k]);
  const Vector free = dimension == 2 ? Vector(velocity(plane)) : Vector(velocity);
  if (dimension == 2) inverse_mass = Vector(inverse_mass(plane));
  problem.w = trace * inverse_mass.asDiagonal() * trace.transpose();
  problem.w.triangularView<Eigen::StrictlyUpper>() = problem.w.transpose();
  problem.q = trace * free;
  return problem;
}

FrictionProblem rigid_box(Index points, Index dimension, double friction, unsigned seed) {
  std::mt19937 random(seed);
  const Eigen::Vector3d sides(1.0, 0.7, 0.2 + 0.8 * std::abs(uniform(random)));
  const Index along = dimension == 2 ? points : Index(std::ceil(std::sqrt(double(points))));
  const Index across = dimension == 2 ? 1 : (points + along - 1) / along;
  const auto on_grid = [](Index i, Index count) { return count > 1 ? 2.0 * double(i) / double(count - 1) - 1.0 : 0.0; };
  std::vector<RigidPoint> places;
  for (Index i = 0; i < points; ++i) {
    const double x = seed % 2 == 0 ? on_grid(i % along, along) : uniform(random);
    const double y = dimension == 2 ? 0.0 : seed % 2 == 0 ? on_grid(i / along, across) : uniform(random);
    places.push_back({{0.5 * sides.x() * x, 0.5 * sides.y() * y, -0.5 * sides.z()}, Eigen::Vector3d::UnitZ()});
  }
  Eigen::Matrix<double, 6, 1> velocity = uniform(6, random);
  velocity[2] = -0.2 - std::abs(velocity[2]);
  return rigid_problem(places, sides, velocity, dimension, friction);
}

FrictionProblem wedged_body(Index points, Index dimension, double friction, double angle, double push, double softness,
                            double preload, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<RigidPoint> places;
  for (Index i = 0; i < points; ++i) {
    const bool funnel = dimension == 3 && seed % 2 == 1;
    const double turn = funnel ? 2.0 * std::numbers::pi * double(i) / double(points) : std::numbers::pi * double(i % 2);
    const Eigen::Vector3d outward(std::cos(turn), std::sin(turn), 0.0);
    Eigen::Vector3d normal = -std::cos(angle) * outward;
    normal.z() += std::sin(angle);
    Eigen::Vector3d place = (1.0 + 0.5 * uniform(random)) * std::sin(angle) * outward;
    place.z() = place.head<2>().norm() / std::tan(angle) - std::cos(angle);
    if (dimension == 3 && !funnel) place.y() = uniform(random);
    if (dimension == 2) normal.y() = place.y() = 0.0;
    places.push_back({place, normal});
  }
  Eigen::Matrix<double, 6, 1> velocity = 0.2 * uniform(6, random);
  velocity[2] = -push;
  FrictionProblem problem = rigid_problem(places, Eigen::Vector3d(1.0, 1.0, 1.0), velocity, dimension, friction);
  const double compliance = softness * problem.w.diagonal().mean();
  for (Index i = 0; i < points; ++i) {
    for (Index j = 0; j < points; ++j) {
      const Eigen::Vector3d apart = places[std::size_t(i)].position - places[std::size_t(j)].position;
      problem.w.block(dimension * i, dimension * j, dimension, dimension).diagonal().array() +=
          compliance * std::exp(-8.0 * apart.norm());
    }
    problem.q[dimension * i] -= preload;
  }
  return problem;
}

FrictionProblem twice(const FrictionProblem& single) {
  const Index rows = single.q.size();
  FrictionProblem problem = single;
  problem.w = single.w.replicate(2, 2);
  for (Vector FrictionProblem::*member :
       {&FrictionProblem::q, &FrictionProblem::rounding, &FrictionProblem::coefficient, &FrictionProblem::bound})
    problem.*member = (single.*member).replicate(2, 1);
  for (std::size_t i = 1; i < single.row_offset.size(); ++i) problem.row_offset.push_back(rows + single.row_offset[i]);
  problem.eligible.insert(problem.eligible.end(), single.eligible.begin(), single.eligible.end());
  return problem;
}

Vector decades_of(Index points, Index dimension, double decades, Index per_body, std::mt19937& random) {
  const Index bodies = (points + per_body - 1) / per_body;
  std::vector<double> factors;
  for (Index k = 0; k < bodies; ++k)
    factors.push_back(std::pow(10.0, -decades * double(k) / double(std::max<Index>(bodies - 1, 1))));
  for (std::size_t k = factors.size(); k > 1; --k) std::swap(factors[k - 1], factors[random() % k]);
  Vector result(dimension * points);
  for (Index i = 0; i < points; ++i)
    result.segment(dimension * i, dimension).setConstant(factors[std::size_t(i / per_body)]);
  return result;
}

FrictionProblem unequal_bodies(Index points, Index dimension, double friction, double decades, double power,
                               unsigned seed) {
  std::mt19937 random(seed);
  FrictionProblem problem(std::vector<Index>(std::size_t(points), dimension), friction);
  const Index rows = dimension * points;
  problem.w = 0.05 * random_operator(rows, 1.0, random);
  for (Index i = 0; i < points; i += 5) {
    const Index size = std::min<Index>(5, points - i) * dimension;
    problem.w.block(dimension * i, dimension * i, size, size) += random_operator(size, 2.0, random);
  }
  const Vector root = decades_of(points, dimension, 0.5 * decades, 5, random);
  problem.w = root.asDiagonal() * problem.w * root.asDiagonal();
  problem.q = uniform(rows, random).cwiseProduct(Vector(root.array().pow(power)));
  return problem;
}

ContactProblem lattice_problem(Index side, Index dimension, double friction, double coupling, double pressing,
                               unsigned seed) {
  constexpr double least = 1e-3;
  std::mt19937 random(seed);
  const Index rows = side * side * dimension;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < side * side; ++i) {
    for (Index k = 0; k < dimension; ++k)
      entries.emplace_back(dimension * i + k, dimension * i + k, 4.0 * (1.0 + least));
    for (const Index j : {i % side + 1 < side ? i + 1 : -1, i + side < side * side ? i + side : -1}) {
      if (j < 0) continue;
      // A small rotation of normal into tangential directions: its 2-norm is one, so that W stays positive definite.
      const double turn = 0.3 * uniform(random);
      for (Index k = 0; k < dimension; ++k) {
        for (Index l = 0; l < dimension; ++l) {
          double value = k == l ? 1.0 : 0.0;
          if (k < 2 && l < 2) value = k == l ? std::cos(turn) : (k < l ? std::sin(turn) : -std::sin(turn));
          if (value == 0.0) continue;
          value *= coupling;
          entries.emplace_back(dimension * i + k, dimension * j + l, value);
          entries.emplace_back(dimension * j + l, dimension * i + k, value);
        }
      }
    }
  }
  SparseMatrix w(rows, rows);
  w.setFromTriplets(entries.begin(), entries.end());
  Vector q = uniform(rows, random);
  for (Index i = 0; i < side * side; ++i) q[dimension * i] -= pressing;
  return {dimension, make_sparse_operator(std::move(w)), q, Vector::Constant(side * side, friction)};
}

Judgement judge(const ContactProblem& problem, const Vector& reaction) {
  using Long = long double;
  using LongVector = Eigen::Matrix<Long, Eigen::Dynamic, 1>;
  LongVector u = problem.offset.cast<Long>(), size = u.cwiseAbs();
  const Matrix* dense = problem.contact_operator->dense();
  const SparseMatrix* sparse = problem.contact_operator->sparse();
  for (Index j = 0; j < problem.rows(); ++j) {
    if (reaction[j] == 0.0) continue;
    const auto add = [&](Index i, double w) {
      u[i] += Long(w) * Long(reaction[j]);
      size[i] += std::abs(Long(w) * Long(reaction[j]));
    };
    if (dense != nullptr) {
      for (Index i = 0; i < problem.rows(); ++i) add(i, (*dense)(i, j));
    } else {
      for (SparseMatrix::InnerIterator entry(*sparse, j); entry; ++entry) add(entry.row(), entry.value());
    }
  }
  Long data = 0, residual = 0, beyond = 0, own = 0, outside = 0;
  for (Index i = 0; i < problem.points(); ++i) {
    if (!problem.is_eligible(i)) continue;
    const Index row = problem.row_offset[std::size_t(i)];
    const Index rows = problem.row_offset[std::size_t(i) + 1] - row;
    const Long friction = rows > 1 ? Long(problem.friction_coefficient[i]) : Long(0);
    const Index count = friction > 0 ? rows : 1;
    const Long w = problem.contact_operator->block(row, count).diagonal().cast<Long>().mean();
    if (!(w > 0)) continue;
    const auto take = [&](const auto& rows_of) {
      Eigen::Vector3<Long> result = Eigen::Vector3<Long>::Zero();
      for (Index k = 0; k < count; ++k) result[k] = rows_of[row + k];
      return result;
    };
    const auto map = [&](const Eigen::Vector3<Long>& r, Eigen::Vector3<Long> step) -> Long {
      step[0] += friction * step.template tail<2>().norm();
      return (r - project_long(friction, r - step / w)).norm() * std::sqrt(w);
    };
    const Eigen::Vector3<Long> r = take(reaction), terms = take(size);
    const Long at_rest = map(Eigen::Vector3<Long>::Zero(), take(problem.offset));
    const Long value = map(r, take(u));
    const Long tangential = terms.tail<2>().maxCoeff();
    const Long floor = 32 * Long(std::numeric_limits<double>::epsilon()) *
                       (std::max(terms[0], tangential) + friction * tangential) / std::sqrt(w);
    data = std::max(data, at_rest);
    residual = std::max(residual, value);
    beyond = std::max(beyond, value - floor);
    own = std::max(own, value / std::max(at_rest, terms.norm() / std::sqrt(w)));
    if (r.norm() > 0)
      outside = std::max({outside, (r.tail<2>().norm() - friction * r[0]) / r.norm(), -r[0] / r.norm()});
    if (!(r.norm() < std::numeric_limits<double>::infinity())) residual = std::numeric_limits<Long>::infinity();
  }
  if (data == 0) data = 1;
  return {double(residual / data), double(beyond / data), double(own), double(outside)};
}

}  // namespace ricochet::test_support
