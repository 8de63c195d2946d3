#include "ricochet/simulation/statics/rigid_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

namespace {

/// Fraction of the loads that is rounding.
constexpr double rounding = 1e-11;
/// Largest fraction of the load's power on a motion that reactions may balance if the motion is to be a proof.
constexpr double proof = 1e-3;
/// Likewise, for a motion that is accurate to the digits that are shown.
constexpr double settled = 1e-9;
/// Fraction of the loads above which a distance that no column reduces any more counts as nonzero: its square has the
/// rounding of the loads' square.
constexpr double resolution = 1e-7;
constexpr int column_limit = 2000;

/// Rigid motions of a body that its supports leave free, as orthonormal combinations of translations and of rotations
/// about its centre with speed one at its rim.
class FreeMotions {
 public:
  FreeMotions(const SemidiscreteProblem& problem, const std::vector<Index>& members)
      : problem_(problem), d_(problem.dimension), in_body_(std::size_t(problem.nodes.cols()), 0) {
    centre_ = Vector::Zero(d_);
    for (const Index node : members) centre_ += problem.nodes.col(node) / double(members.size());
    for (const Index node : members) {
      in_body_[std::size_t(node)] = 1;
      size_ = std::max(size_, (problem.nodes.col(node) - centre_).norm());
    }
    const Index all = size_ > 0.0 && !problem.axisymmetric ? (d_ == 2 ? 3 : 6) : d_;
    leave_to_supports(members, all);
    if (count() > 0 && all > d_ && rotations_strain(members)) leave_to_supports(members, d_);
  }

  [[nodiscard]] Index count() const { return modes_.cols(); }
  [[nodiscard]] bool contains(Index dof) const { return in_body_[std::size_t(dof / d_)] != 0; }
  [[nodiscard]] const Vector& centre() const { return centre_; }
  /// Adds factor × the generalized force of a unit force on this dof; ignores dofs of other bodies.
  void add_force(Index dof, double factor, Vector& force) const {
    if (!contains(dof)) return;
    force.noalias() += modes_.transpose() * (factor * speeds(dof)).head(modes_.rows());
  }
  /// Velocity of the centre.
  [[nodiscard]] Vector velocity(const Vector& motion) const { return (modes_ * motion).head(d_); }

 private:
  using Speeds = Eigen::Matrix<double, 6, 1>;

  /// Speeds at a dof due to the translations and then the rotations.
  [[nodiscard]] Speeds speeds(Index dof) const {
    Speeds result = Speeds::Zero();
    const Index component = dof % d_;
    result[component] = 1.0;
    if (!(size_ > 0.0)) return result;
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (Index k = 0; k < d_; ++k) x[k] = (problem_.nodes(k, dof / d_) - centre_[k]) / size_;
    for (Index k = d_; k < (d_ == 2 ? 3 : 6); ++k) {
      const Index axis = d_ == 2 ? 2 : k - d_;
      result[k] = Eigen::Vector3d::Unit(axis).cross(x)[component];
    }
    return result;
  }

  /// Returns whether rotations cause strain: linear functions on curved cells do not contain them.
  [[nodiscard]] bool rotations_strain(const std::vector<Index>& members) const {
    const SparseMatrix& stiffness = problem_.internal_force->tangent();
    for (const Index node : members) {
      for (Index dof = node * d_; dof < (node + 1) * d_; ++dof) {
        Speeds force = Speeds::Zero(), terms = Speeds::Zero();
        for (SparseMatrix::InnerIterator entry(stiffness, dof); entry; ++entry) {
          const Speeds part = entry.value() * speeds(entry.row());
          force += part;
          terms += part.cwiseAbs();
        }
        if (force.lpNorm<Eigen::Infinity>() > 1e-9 * terms.maxCoeff()) return true;
      }
    }
    return false;
  }

  /// Restricts the first motions to the combinations that are at rest where the body is held.
  void leave_to_supports(const std::vector<Index>& members, Index motions) {
    Matrix square = Matrix::Zero(motions, motions);
    if (problem_.axisymmetric) square(0, 0) = 1.0;  // the rings hold it across the axis
    for (const Index node : members) {
      for (Index dof = node * d_; dof < (node + 1) * d_; ++dof) {
        if (!problem_.supports.contains(dof)) continue;
        const Vector speed = speeds(dof).head(motions);
        square += speed * speed.transpose();
      }
    }
    modes_ = Matrix::Identity(motions, motions);
    if (square.isZero(0.0)) return;
    const SymmetricEigen eigen = symmetric_eigen(square);
    Index free = 0;
    while (free < motions && eigen.values[free] <= 1e-12 * eigen.values[motions - 1]) ++free;
    modes_ = eigen.vectors.leftCols(free);
  }

  const SemidiscreteProblem& problem_;
  Index d_;
  std::vector<char> in_body_;
  Vector centre_;
  double size_ = 0.0;
  Matrix modes_;  ///< (translations, rotations) × free motions
};

/// Generalized forces of the reactions at a contact point.
struct Cone {
  Vector normal;
  Matrix tangential;  ///< one column per tangent
  double coefficient = 0.0;
  bool is_rough = false;  ///< tangential forces are unlimited
  Index point = 0;
};

/// Point of the sum of all cones that is nearest to a target: non-negative least squares with columns that are
/// generated as needed.
class NearestForce {
 public:
  NearestForce(const std::vector<Cone>& cones, Vector target, double unit)
      : cones_(cones), residual_(target), target_(std::move(target)), unit_(unit) {}

  /// Returns true if the residual is more than rounding and no reaction can balance more than a small fraction of it.
  bool is_out_of_reach() {
    bool is_proved = false;
    for (int k = 0; k < column_limit; ++k) {
      const double length = residual_.norm();
      if (length <= rounding * unit_) return false;
      double best = 0.0;
      Vector column;
      Index point = -1;
      for (const Cone& cone : cones_) {
        const Vector candidate = best_column(cone);
        const double size = candidate.norm();
        if (!(size > 0.0) || residual_.dot(candidate) <= best * size) continue;
        best = residual_.dot(candidate) / size;
        column = candidate / size;
        point = cone.point;
      }
      if (best <= settled * length * (length / unit_)) return true;
      is_proved = best <= proof * length * (length / unit_);
      if (!enter(column, point)) return is_proved || length > resolution * unit_;
    }
    return is_proved;
  }

  [[nodiscard]] const Vector& residual() const { return residual_; }
  [[nodiscard]] double unit() const { return unit_; }
  /// Weights and contact points of the active forces.
  [[nodiscard]] const std::vector<double>& sizes() const { return sizes_; }
  [[nodiscard]] const std::vector<Index>& points() const { return points_; }

 private:
  /// Returns the reaction at a point that reduces the residual most.
  [[nodiscard]] Vector best_column(const Cone& cone) const {
    const Vector along = cone.tangential.transpose() * residual_;
    const double length = along.norm();
    if (!(length > 0.0) || (!cone.is_rough && cone.coefficient == 0.0)) return cone.normal;
    const Vector friction = cone.tangential * (along / length);
    return cone.is_rough ? friction : Vector(cone.normal + cone.coefficient * friction);
  }

  /// Adds a column. Returns false if the residual does not decrease.
  bool enter(const Vector& column, Index point) {
    const double before = residual_.norm();
    columns_.push_back(column);
    points_.push_back(point);
    sizes_.push_back(0.0);
    while (true) {
      Matrix all(target_.size(), Index(columns_.size()));
      for (std::size_t k = 0; k < columns_.size(); ++k) all.col(Index(k)) = columns_[k];
      const Vector unconstrained = PivotedQr(all).solve(target_);
      double part = 1.0;
      for (std::size_t k = 0; k < sizes_.size(); ++k) {
        const double to = unconstrained[Index(k)];
        if (to <= 0.0) part = std::min(part, sizes_[k] > 0.0 ? sizes_[k] / (sizes_[k] - to) : 0.0);
      }
      for (std::size_t k = sizes_.size(); k-- > 0;) {
        const double to = unconstrained[Index(k)];
        const bool leaves = to <= 0.0 && sizes_[k] + part * (to - sizes_[k]) <= 1e-15 * sizes_[k];
        sizes_[k] += part * (to - sizes_[k]);
        if (!leaves) continue;
        const auto at = std::ptrdiff_t(k);
        columns_.erase(columns_.begin() + at);
        points_.erase(points_.begin() + at);
        sizes_.erase(sizes_.begin() + at);
      }
      if (part < 1.0 && !columns_.empty()) continue;
      residual_ = target_;
      for (std::size_t k = 0; k < columns_.size(); ++k) residual_ -= sizes_[k] * columns_[k];
      return residual_.norm() < before;
    }
  }

  const std::vector<Cone>& cones_;
  Vector residual_, target_;
  double unit_;
  std::vector<Vector> columns_;
  std::vector<Index> points_;
  std::vector<double> sizes_;
};

std::vector<Cone> make_cones(const SemidiscreteProblem& problem, const FreeMotions& motions,
                             const std::vector<char>& frictionless) {
  const ContactBoundary& contact = problem.contact;
  const ContactRows& rows = *contact.rows;
  const Index tangents = problem.dimension - 1;
  std::vector<Cone> cones;
  for (Index i = 0; i < contact.size(); ++i) {
    // The other body is assumed to bear any reaction: a load that such reactions cannot balance, the real body cannot
    // balance either.
    bool reaches = false;
    contact.visit_nodes(i,
                        [&](Index node, double) { reaches = reaches || motions.contains(node * problem.dimension); });
    if (!reaches) continue;
    Cone cone{Vector::Zero(motions.count()), Matrix::Zero(motions.count(), tangents), 0.0, false, i};
    rows.visit_normal(i, [&](Index dof, double value) { motions.add_force(dof, value, cone.normal); });
    if (frictionless.empty() || frictionless[std::size_t(i)] == 0) {
      cone.coefficient = contact.friction_coefficient[i];
      cone.is_rough = cone.coefficient == 0.0 && contact.friction_bound[i] > 0.0;
    }
    for (Index k = 0; k < tangents; ++k) {
      Vector force = Vector::Zero(motions.count());
      rows.visit_tangential(i * tangents + k, [&](Index dof, double value) { motions.add_force(dof, value, force); });
      cone.tangential.col(k) = force;
    }
    cones.push_back(std::move(cone));
  }
  return cones;
}

/// Describes the motion as it would be observed. In the mechanism of Farkas' lemma a body lifts as it slides (its
/// friction law is associated). The lift is an excess of the normal reaction; without it, friction is smaller as well.
UnheldMotion describe(const SemidiscreteProblem& problem, const FreeMotions& motions, const NearestForce& nearest) {
  const Vector unbalanced = motions.velocity(-nearest.residual());
  UnheldMotion result{motions.centre(), unbalanced, false, nearest.residual().norm() / nearest.unit()};
  Vector normal = Vector::Zero(problem.dimension);
  double pressure = 0.0, friction = 0.0;
  for (std::size_t k = 0; k < nearest.points().size(); ++k) {
    const Index point = nearest.points()[k];
    normal += nearest.sizes()[k] * problem.contact.rows->normal(point);
    pressure += nearest.sizes()[k];
    friction += nearest.sizes()[k] * problem.contact.friction_coefficient[point];
  }
  const double length = normal.norm();
  if (length > 0.0) {
    normal /= length;
    result.slides = true;
    const double lift = unbalanced.dot(normal);
    result.force -= lift * normal;
    const double along = result.force.norm();
    if (along > 0.0) result.force *= 1.0 + friction / pressure * std::max(lift, 0.0) / along;
  }
  const double visible = 1e-6 * nearest.residual().norm();
  for (double& component : result.force) {
    if (!(std::abs(component) > visible)) component = 0.0;
  }
  return result;
}

std::optional<UnheldMotion> find_in_body(const SemidiscreteProblem& problem, const std::vector<Index>& members,
                                         const Vector& load, const std::vector<char>& frictionless) {
  const FreeMotions motions(problem, members);
  if (motions.count() == 0) return {};
  Vector force = Vector::Zero(motions.count());
  double unit = 0.0;
  for (const Index node : members) {
    for (Index dof = node * problem.dimension; dof < (node + 1) * problem.dimension; ++dof) {
      motions.add_force(dof, load[dof], force);
      unit += std::abs(load[dof]);
    }
  }
  const std::vector<Cone> cones = make_cones(problem, motions, frictionless);
  NearestForce nearest(cones, -force, unit);
  if (!nearest.is_out_of_reach()) return {};
  return describe(problem, motions, nearest);
}

}  // namespace

std::optional<UnheldMotion> find_unheld_motion(const SemidiscreteProblem& problem,
                                               const std::vector<char>& frictionless) {
  Vector load;
  problem.loads.total(0.0, load);
  std::optional<UnheldMotion> worst;
  for (const std::vector<Index>& members : graph_components(problem.internal_force->graph(problem.dimension))) {
    const std::optional<UnheldMotion> found = find_in_body(problem, members, load, frictionless);
    if (found && (!worst || found->unbalanced > worst->unbalanced)) worst = found;
  }
  return worst;
}

}  // namespace ricochet
