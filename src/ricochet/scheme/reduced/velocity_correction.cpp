#include "ricochet/scheme/reduced/velocity_correction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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
  modes_.resize(std::size_t(mode_count()));
}

void VelocityCorrection::start(const Vector& end) {
  find_centres(end);
  go_to(end);
  const int count = mode_count();
  systems_.assign(bodies_.count(), SixMatrix::Zero(count, count));
  for (int k = 0; k < count; ++k) {
    Vector& mode = modes_[std::size_t(k)];
    set_mode(k, mode);
    mask(mode);
    problem_.mass.multiply(mode, momentum_);
    find_resultants(momentum_);
    for (std::size_t body = 0; body < systems_.size(); ++body) systems_[body].col(k) = resultants_[body];
  }
}

const Vector& VelocityCorrection::of_momenta(const Vector& residual, const Vector& middle, double step,
                                             Vector& support_reaction) {
  go_to(middle);
  find_resultants(residual);
  for (std::size_t body = 0; body < supports_.size(); ++body) {
    if (!supports_[body].empty()) leave_to_supports(body, support_reaction);
  }
  value_.setZero(residual.size());
  add_motions(step, value_);
  return value_;
}

bool VelocityCorrection::find(const Vector& velocity, const Vector& end, double change) {
  value_ = velocity;
  mask(value_);
  problem_.mass.multiply(value_, momentum_);
  go_to(end);
  find_resultants(momentum_);
  add_motions(-1.0, value_);
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

template <class Work>
void VelocityCorrection::for_each_node(const Work& work) const {
  for (Index node = 0; node < problem_.nodes.cols(); ++node) {
    const int body = bodies_.body_of_node(node);
    if (body >= 0) work(node, std::size_t(body));
  }
}

void VelocityCorrection::find_centres(const Vector& displacement) {
  const Index d = problem_.dimension;
  centres_.setZero(d, Index(bodies_.count()));
  sizes_.setZero(centres_.cols());
  for_each_node([&](Index node, std::size_t body) {
    centres_.col(Index(body)) += problem_.nodes.col(node) + displacement.segment(node * d, d);
    sizes_[Index(body)] += 1.0;
  });
  for (Index body = 0; body < sizes_.size(); ++body) centres_.col(body) /= sizes_[body];
}

/// Sets the positions relative to the centres.
void VelocityCorrection::go_to(const Vector& displacement) {
  positions_ = problem_.nodes + displacement.reshaped(problem_.dimension, problem_.nodes.cols());
  for_each_node([&](Index node, std::size_t body) { positions_.col(node) -= centres_.col(Index(body)); });
}

/// Value of a mode at a node.
SpaceVector VelocityCorrection::motion(int mode, Index node) const {
  const Index d = problem_.dimension;
  if (problem_.axisymmetric) return Eigen::Vector2d(0.0, 1.0);
  if (mode < d) return SpaceVector::Unit(d, mode);
  if (d == 2) return Eigen::Vector2d(-positions_(1, node), positions_(0, node));
  return Eigen::Vector3d::Unit(mode - d).cross(Eigen::Vector3d(positions_.col(node)));
}

/// Writes the values of a mode of every body.
void VelocityCorrection::set_mode(int mode, Vector& values) const {
  const Index d = problem_.dimension;
  values.setZero(problem_.dof_count());
  for_each_node([&](Index node, std::size_t) { values.segment(node * d, d) = motion(mode, node); });
}

void VelocityCorrection::mask(Vector& values) const {
  for (const Index dof : problem_.supports.dofs()) values[dof] = 0.0;
  for (const Index dof : problem_.massless_dofs) values[dof] = 0.0;
  values.tail(values.size() - problem_.cell_node_count() * problem_.dimension).setZero();
}

/// Computes the resultant and the moment about the centre of nodal forces on each body: products with its modes.
void VelocityCorrection::find_resultants(const Vector& forces) {
  const Index d = problem_.dimension;
  resultants_.assign(bodies_.count(), SixVector::Zero(mode_count()));
  for_each_node([&](Index node, std::size_t body) {
    const auto force = forces.segment(node * d, d);
    SixVector& of_body = resultants_[body];
    if (problem_.axisymmetric) {
      of_body[0] += force[1];
      return;
    }
    of_body.head(d) += force;
    const auto place = positions_.col(node);
    if (d == 2) {
      of_body[2] += place[0] * force[1] - place[1] * force[0];
    } else {
      of_body.tail(3) += Eigen::Vector3d(place).cross(Eigen::Vector3d(force));
    }
  });
}

/// Leaves the resultants of a residual, as far as supports can, to forces Σ c_k r_k of the supports of a body. What
/// remains belongs to motions that the supports permit.
void VelocityCorrection::leave_to_supports(std::size_t body, Vector& support_reaction) {
  const int count = mode_count();
  const auto row_of = [&](Index support) {
    const Index dof = problem_.supports.dofs()[std::size_t(support)], d = problem_.dimension;
    SixVector row(count);
    for (int k = 0; k < count; ++k) row[k] = motion(k, dof / d)[dof % d];
    return row;
  };
  SixMatrix system = SixMatrix::Zero(count, count);
  for (const Index support : supports_[body]) {
    const SixVector row = row_of(support);
    system += row * row.transpose();
  }
  SixVector& resultant = resultants_[body];
  const SixVector parts = SixLeastNormSolver(system, same_motion).solve(resultant);
  resultant -= system * parts;
  for (const Index support : supports_[body]) support_reaction[support] -= row_of(support).dot(parts);
}

/// Adds the motions of the bodies, in the modes, whose momenta are a multiple of the resultants.
void VelocityCorrection::add_motions(double factor, Vector& velocity) {
  const Index d = problem_.dimension;
  // Supports may leave fewer than these motions.
  for (std::size_t body = 0; body < systems_.size(); ++body)
    resultants_[body] = factor * SixLeastNormSolver(systems_[body], same_motion).solve(resultants_[body]);
  for (int k = 0; k < mode_count(); ++k) {
    const Vector& mode = modes_[std::size_t(k)];
    for_each_node([&](Index node, std::size_t body) {
      velocity.segment(node * d, d) += resultants_[body][k] * mode.segment(node * d, d);
    });
  }
}

}  // namespace ricochet
