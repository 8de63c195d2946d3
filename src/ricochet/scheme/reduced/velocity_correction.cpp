#include "ricochet/scheme/reduced/velocity_correction.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"

namespace ricochet {

bool VelocityCorrection::find(const Vector& velocity, const Vector& displacement, double change) {
  find_relative(velocity, displacement);
  problem_.mass.multiply(value_, momentum_);
  const double square = value_.dot(momentum_), slope = velocity.dot(momentum_);
  const double discriminant = slope * slope + 2.0 * square * change;
  if (!(slope > 0.0) || !(discriminant >= 0.0)) return false;
  const double part = 2.0 * change / (slope + std::sqrt(discriminant));
  if (!(std::abs(part) <= largest_part)) return false;
  value_ *= part;
  return true;
}

/// Number of modes, translations first; for axisymmetric bodies only that along their axis.
int VelocityCorrection::mode_count() const {
  if (problem_.axisymmetric) return 1;
  return problem_.dimension == 2 ? 3 : 6;
}

/// Writes the values of a mode of every body.
void VelocityCorrection::set_mode(int mode, Vector& values) const {
  const int d = problem_.dimension;
  values.setZero(problem_.dof_count());
  for (Index node = 0; node < positions_.cols(); ++node) {
    if (bodies_.body_of_node(node) < 0) continue;
    auto at = values.segment(node * d, d);
    if (problem_.axisymmetric) {
      at[1] = 1.0;
    } else if (mode < d) {
      at[mode] = 1.0;
    } else if (d == 2) {
      at << -positions_(1, node), positions_(0, node);
    } else {
      at = Eigen::Vector3d::Unit(mode - d).cross(Eigen::Vector3d(positions_.col(node)));
    }
  }
}

void VelocityCorrection::mask(Vector& values) const {
  for (const Index dof : problem_.supports.dofs()) values[dof] = 0.0;
  for (const Index dof : problem_.massless_dofs) values[dof] = 0.0;
  values.tail(values.size() - problem_.cell_node_count() * problem_.dimension).setZero();
}

/// Computes w.
void VelocityCorrection::find_relative(const Vector& velocity, const Vector& displacement) {
  const Index d = problem_.dimension;
  const int modes = mode_count();
  positions_ = problem_.nodes + displacement.reshaped(d, problem_.nodes.cols());
  Points centres = Points::Zero(d, Index(bodies_.count()));
  Vector sizes = Vector::Zero(centres.cols());
  const auto visit = [&](const auto& work) {
    for (Index node = 0; node < positions_.cols(); ++node) {
      const int body = bodies_.body_of_node(node);
      if (body >= 0) work(node, std::size_t(body));
    }
  };
  visit([&](Index node, std::size_t body) {
    centres.col(Index(body)) += positions_.col(node);
    sizes[Index(body)] += 1.0;
  });
  visit([&](Index node, std::size_t body) { positions_.col(node) -= centres.col(Index(body)) / sizes[Index(body)]; });

  value_ = velocity;
  mask(value_);
  // Column k: r_jᵀ M P r_k; the last: r_jᵀ M P v₁.
  std::vector<Matrix> systems(bodies_.count(), Matrix::Zero(modes, modes + 1));
  Vector other;
  for (int k = 0; k <= modes; ++k) {
    if (k < modes) {
      set_mode(k, mode_);
      mask(mode_);
    }
    problem_.mass.multiply(k < modes ? mode_ : value_, momentum_);
    for (int j = 0; j < modes; ++j) {
      set_mode(j, other);
      visit([&](Index node, std::size_t body) {
        systems[body](j, k) += other.segment(node * d, d).dot(momentum_.segment(node * d, d));
      });
    }
  }
  // Supports may leave fewer than these motions.
  std::vector<Vector> parts;
  parts.reserve(systems.size());
  for (const Matrix& system : systems)
    parts.push_back(LeastNormSolver(system.leftCols(modes), 1e-12).solve(Vector(system.col(modes))));
  for (int k = 0; k < modes; ++k) {
    set_mode(k, mode_);
    mask(mode_);
    visit([&](Index node, std::size_t body) {
      value_.segment(node * d, d) -= parts[body][k] * mode_.segment(node * d, d);
    });
  }
}

}  // namespace ricochet
