#include "ricochet/scheme/semi_explicit/explicit_motion.hpp"

#include "ricochet/base/parallel.hpp"
#include "ricochet/scheme/semi_explicit/supported_motion.hpp"

namespace ricochet {

void ExplicitMotion::analyse(const SemidiscreteProblem& problem, double step) {
  mass_ = problem.mass.diagonal();
  damping_ = problem.has_damping() ? Vector(problem.damping.matrix().diagonal()) : Vector();
  ranks_ = problem.ranks;
  inverse_mass_ = mass_;
  if (problem.has_damping()) inverse_mass_ += (0.5 * step) * damping_;
  ranks_->accumulate(inverse_mass_);
  for (const Index dof : problem.supports.dofs()) inverse_mass_[dof] = 0.0;
  for (double& m : inverse_mass_) m = m > 0.0 ? 1.0 / m : 0.0;
}

void ExplicitMotion::predict(const SemidiscreteProblem& problem, double step, const State& state,
                             Vector& increment) const {
  increment = step * (state.velocity + (0.5 * step) * state.acceleration);
  const Vector& next = state.memory.at(supported_next, problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    increment[dof] = next[i] - state.displacement[dof];
  }
}

/// Makes one pass over memory.
void ExplicitMotion::move(const SemidiscreteProblem& problem, const Vector& correction, double step, State& state,
                          Vector& increment) {
  const Index count = state.displacement.size();
  const Vector& next = state.memory.at(supported_next, problem.supports.size());
  support_increment_.resize(problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    support_increment_[i] = next[i] - state.displacement[dof];
  }
  increment.resize(count);
  double* const u = state.displacement.data();
  double* const v = state.velocity.data();
  double* const du = increment.data();
  const double* const a = state.acceleration.data();
  parallel_ranges(count, [=](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      v[i] += 0.5 * step * a[i];
      du[i] = step * v[i];
      u[i] += du[i];
    }
  });
  for (const Index dof : problem.contact_dofs) {
    du[dof] += correction[dof];
    u[dof] += correction[dof];
  }
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    u[dof] = next[i];
    du[dof] = support_increment_[i];
  }
}

/// Makes one pass over memory, on a single rank.
void ExplicitMotion::accelerate(const Vector& force, const Vector& load, double step, State& state) {
  const double half = 0.5 * step;
  if (ranks_->are_several()) {
    residual_ = load - force;
    if (damping_.size() > 0) residual_ -= damping_.cwiseProduct(state.velocity);
    ranks_->accumulate(residual_);
    state.acceleration = inverse_mass_.cwiseProduct(residual_);
    state.velocity += half * state.acceleration;
    return;
  }
  const Index count = force.size();
  const double* const l = load.data();
  const double* const f = force.data();
  const double* const inverse = inverse_mass_.data();
  double* const a = state.acceleration.data();
  double* const v = state.velocity.data();
  const double* const c = damping_.size() > 0 ? damping_.data() : nullptr;
  parallel_ranges(count, [=](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const double damping_force = c != nullptr ? c[i] * v[i] : 0.0;
      a[i] = inverse[i] * (l[i] - f[i] - damping_force);
      v[i] += half * a[i];
    }
  });
}

}  // namespace ricochet
