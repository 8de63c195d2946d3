#include "ricochet/scheme/reduced/velocity_correction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ricochet {

namespace {

/// Below it, relative to the largest pivot, a motion of a body counts as impossible, or supports as without force on
/// it.
constexpr double same_motion = 1e-12;

}  // namespace

VelocityCorrection::VelocityCorrection(const SemidiscreteProblem& problem, const BodyRotations& bodies)
    : problem_(problem), bodies_(bodies), supports_(bodies.count()) {
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const int body = bodies.body_of_node(problem.supports.dofs()[std::size_t(i)] / problem.dimension);
    if (body >= 0) supports_[std::size_t(body)].push_back(i);
  }
  const Index d = problem.dimension, modes = d == 2 ? 3 : 6;
  systems_.assign(bodies.count(), SixMatrix::Zero(modes, modes));
  resultants_.assign(bodies.count(), SixVector::Zero(modes));
  positions_.setZero(problem.dof_count());
  weighted_.assign(std::size_t(d - 1), positions_);
  sums_.assign(bodies.count(), MomentSums(d + 1, 3 * d));
  Vector sum = Vector::Zero(problem.dof_count());
  for_each_node([&](Index node, std::size_t) {
    sum.segment(node * d, d).setOnes();
    if (problem.axisymmetric) sum[node * d] = 0.0;  // bodies cannot move across their axis
  });
  mask(sum);
  problem.mass.multiply(sum, inertia_);
  find_scales();
}

/// Computes scales from the extents of the bodies: powers of two, so that units of length do not change results.
void VelocityCorrection::find_scales() {
  scales_.setOnes(Index(bodies_.count()));
  Points least = Points::Constant(problem_.dimension, scales_.size(), std::numeric_limits<double>::infinity());
  Points largest = -least;
  for_each_node([&](Index node, std::size_t body) {
    least.col(Index(body)) = least.col(Index(body)).cwiseMin(problem_.nodes.col(node));
    largest.col(Index(body)) = largest.col(Index(body)).cwiseMax(problem_.nodes.col(node));
  });
  for (Index body = 0; body < scales_.size(); ++body) {
    const double extent = (largest.col(body) - least.col(body)).maxCoeff();
    if (extent > 0.0) scales_[body] = std::ldexp(1.0, 1 - std::ilogb(extent));
  }
}

void VelocityCorrection::start(const Vector& end) {
  has_systems_ = false;
  positions_ = problem_.nodes.reshaped() + end;
  if (problem_.dimension == 2) {
    leave_centres<2>();
  } else {
    leave_centres<3>();
  }
}

const Vector& VelocityCorrection::of_momenta(const Vector& residual, const Vector& middle, double step,
                                             Vector& support_reaction) {
  value_.setZero(residual.size());
  momentum_.setZero(residual.size());
  if (problem_.dimension == 2) {
    find_momenta_of_residual<2>(residual, middle, step, support_reaction);
  } else {
    find_momenta_of_residual<3>(residual, middle, step, support_reaction);
  }
  return value_;
}

bool VelocityCorrection::find(const Vector& velocity, double change) {
  value_ = velocity;
  mask(value_);
  problem_.mass.multiply(value_, momentum_);
  if (problem_.dimension == 2) {
    remove_motions<2>();
  } else {
    remove_motions<3>();
  }
  const double square = value_.dot(momentum_), slope = velocity.dot(momentum_);
  const double discriminant = slope * slope + 2.0 * square * change;
  if (!(slope > 0.0) || !(discriminant >= 0.0)) return false;
  const double part = 2.0 * change / (slope + std::sqrt(discriminant));
  if (!(std::abs(part) <= largest_part)) return false;
  value_ *= part;
  momentum_ *= part;
  return true;
}

template <class Work>
void VelocityCorrection::for_each_node(const Work& work) const {
  for (Index node = 0; node < problem_.nodes.cols(); ++node) {
    const int body = bodies_.body_of_node(node);
    if (body >= 0) work(node, std::size_t(body));
  }
}

/// Makes positions relative to the centres, and of the order of 1.
template <int d>
void VelocityCorrection::leave_centres() {
  centres_.setZero(d, Index(bodies_.count()));
  sizes_.setZero(centres_.cols());
  for_each_node([&](Index node, std::size_t body) {
    centres_.col(Index(body)).template head<d>() += positions_.segment<d>(node * d);
    sizes_[Index(body)] += 1.0;
  });
  for (Index body = 0; body < sizes_.size(); ++body) centres_.col(body) /= sizes_[body];
  for_each_node([&](Index node, std::size_t body) {
    auto position = positions_.segment<d>(node * d);
    position = scales_[Index(body)] * (position - centres_.col(Index(body)).template head<d>());
  });
}

/// Resultant and moment of a force: its products with the motions of the body. Along an axis only the axial force acts.
template <int d>
VelocityCorrection::Resultant<d> VelocityCorrection::resultant(const Position<d>& position,
                                                               const Position<d>& force) const {
  Resultant<d> result = Resultant<d>::Zero();
  if (d == 2 && problem_.axisymmetric) {
    result[1] = force[1];
  } else if constexpr (d == 2) {
    result << force, position[0] * force[1] - position[1] * force[0];
  } else {
    result << force, position.cross(force);
  }
  return result;
}

/// Scaled position at a displacement, relative to the centre of the body at the end.
template <int d>
VelocityCorrection::Position<d> VelocityCorrection::position(const Vector& displacement, Index node,
                                                             std::size_t body) const {
  return scales_[Index(body)] * (problem_.nodes.col(node).template head<d>() + displacement.segment<d>(node * d) -
                                 centres_.col(Index(body)).template head<d>());
}

void VelocityCorrection::shift(const Vector& values, Index by, Vector& shifted) const {
  const Index d = problem_.dimension;
  shifted.resize(values.size());
  for (Index first = 0; first < values.size(); first += d) {
    for (Index i = 0; i < d; ++i) shifted[first + i] = values[first + (i + by) % d];
  }
}

/// Computes `weighted_`. M acts on each component alone, and P on components of supported nodes.
void VelocityCorrection::weigh_positions() {
  const Index d = problem_.dimension;
  if (problem_.supports.size() == 0) {
    problem_.mass.multiply(positions_, product_);
    for (Index by = 1; by < d; ++by) shift(product_, by, weighted_[std::size_t(by - 1)]);
    return;
  }
  for (Index by = 1; by < d; ++by) {
    shift(positions_, by, product_);
    mask(product_);
    problem_.mass.multiply(product_, weighted_[std::size_t(by - 1)]);
  }
}

template <int d>
void VelocityCorrection::require_systems() {
  if (std::exchange(has_systems_, true)) return;
  if (!problem_.axisymmetric) weigh_positions();
  for (MomentSums& sums : sums_) sums.setZero();
  for_each_node([&](Index node, std::size_t body) {
    Eigen::Matrix<double, d + 1, 1> position;
    position << 1.0, positions_.segment<d>(node * d);
    Eigen::Matrix<double, 3 * d, 1> momentum;
    momentum << inertia_.segment<d>(node * d), weighted_.front().template segment<d>(node * d),
        weighted_.back().template segment<d>(node * d);
    sums_[body].template topLeftCorner<d + 1, 3 * d>() += position * momentum.transpose();
  });
  for (std::size_t body = 0; body < systems_.size(); ++body) find_system<d>(sums_[body], systems_[body]);
}

/// Computes r_jᵀ M P r_k from the sums over the nodes of a body.
template <int d>
void VelocityCorrection::find_system(const MomentSums& sums, SixMatrix& system) const {
  system.setZero();
  // Enters a component of M P r_k in a direction: a column of the sums.
  const auto enter = [&](int mode, int column, int direction, double sign) {
    const Position<d> position = sign * sums.col(column).template segment<d>(1);
    Resultant<d> sum = resultant<d>(position, Position<d>::Unit(direction));
    sum.template head<d>() *= sign * sums(0, column);
    system.col(mode) += sum;
  };
  for (int i = 0; i < d; ++i) enter(i, i, i, 1.0);
  if (problem_.axisymmetric) return;
  for (int axis = d == 2 ? 2 : 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3, mode = d == 2 ? 2 : 3 + axis;
    enter(mode, d + i, i, -1.0);
    enter(mode, 2 * d + j, j, 1.0);
  }
}

template <int d>
void VelocityCorrection::find_momenta_of_residual(const Vector& residual, const Vector& middle, double step,
                                                  Vector& support_reaction) {
  find_resultants<d>(residual, [&](Index node, std::size_t body) { return position<d>(middle, node, body); });
  for (std::size_t body = 0; body < supports_.size(); ++body) {
    if (!supports_[body].empty()) leave_to_supports<d>(body, middle, support_reaction);
  }
  if (std::ranges::all_of(resultants_, [](const SixVector& of_body) { return of_body.isZero(0.0); })) return;
  add_motions<d>(step);
}

/// Computes resultants and moments of nodal forces at these positions: their products with the motions of each body.
template <int d, class PositionOf>
void VelocityCorrection::find_resultants(const Vector& forces, const PositionOf& position_of) {
  for (SixVector& of_body : resultants_) of_body.setZero();
  for_each_node([&](Index node, std::size_t body) {
    resultants_[body].template head<Resultant<d>::SizeAtCompileTime>() +=
        resultant<d>(position_of(node, body), forces.segment<d>(node * d));
  });
}

/// Leaves the resultants of a residual, as far as supports can, to forces Σ c_k r_k of the supports of a body. What
/// remains belongs to motions that the supports permit.
template <int d>
void VelocityCorrection::leave_to_supports(std::size_t body, const Vector& middle, Vector& support_reaction) {
  const auto row_of = [&](Index support) -> SixVector {
    const Index dof = problem_.supports.dofs()[std::size_t(support)];
    return resultant<d>(position<d>(middle, dof / d, body), Position<d>::Unit(dof % d));
  };
  SixVector& resultant = resultants_[body];
  SixMatrix system = SixMatrix::Zero(resultant.size(), resultant.size());
  for (const Index support : supports_[body]) {
    const SixVector row = row_of(support);
    system += row * row.transpose();
  }
  const SixVector parts = SixLeastNormSolver(system, same_motion).solve(resultant);
  resultant -= system * parts;
  for (const Index support : supports_[body]) support_reaction[support] -= row_of(support).dot(parts);
}

/// Removes the motions of the bodies from `value_`, of which `momentum_` is the product with M.
template <int d>
void VelocityCorrection::remove_motions() {
  find_resultants<d>(momentum_,
                     [&](Index node, std::size_t) -> Position<d> { return positions_.segment<d>(node * d); });
  add_motions<d>(-1.0);
}

/// Adds the motions of the bodies whose momenta are a multiple of the resultants.
template <int d>
void VelocityCorrection::add_motions(double factor) {
  require_systems<d>();
  // Supports may leave fewer than these motions.
  for (std::size_t body = 0; body < systems_.size(); ++body)
    resultants_[body] = factor * SixLeastNormSolver(systems_[body], same_motion).solve(resultants_[body]);
  for_each_node([&](Index node, std::size_t body) {
    const Position<d> position = positions_.segment<d>(node * d), velocity = resultants_[body].head<d>();
    Position<d> turning, next, last;  // rotation, and its components by which M P positions are multiplied
    if constexpr (d == 2) {
      const double spin = resultants_[body][2];
      next << spin, 0.0;
      last << 0.0, spin;
      turning << -spin * position[1], spin * position[0];
    } else {
      const Position<d> spin = resultants_[body].tail<d>();
      next << spin[2], spin[0], spin[1];
      last << spin[1], spin[2], spin[0];
      turning = spin.cross(position);
    }
    value_.segment<d>(node * d) += velocity + turning;
    momentum_.segment<d>(node * d) += inertia_.segment<d>(node * d).cwiseProduct(velocity) -
                                      weighted_.front().template segment<d>(node * d).cwiseProduct(next) +
                                      weighted_.back().template segment<d>(node * d).cwiseProduct(last);
  });
  mask(value_);
}

void VelocityCorrection::mask(Vector& values) const {
  for (const Index dof : problem_.supports.dofs()) values[dof] = 0.0;
  for (const Index dof : problem_.massless_dofs) values[dof] = 0.0;
  values.tail(values.size() - problem_.cell_node_count() * problem_.dimension).setZero();
}

}  // namespace ricochet
