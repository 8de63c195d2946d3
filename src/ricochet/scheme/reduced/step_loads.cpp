#include "ricochet/scheme/reduced/step_loads.hpp"

namespace ricochet {

void StepLoads::start(const SemidiscreteProblem& problem, double step, const State& state) {
  start_time_ = state.time;
  end_time_ = state.time + step;
  varies_ = problem.loads.varies();
  follows_ = problem.pressure != nullptr;
  mean_ = problem.loads.constant();
  if (!varies_) {
    if (follows_) rise_.setZero(mean_.size());
    return;
  }
  problem.loads.varying(start_time_, varying_);
  problem.loads.varying(end_time_, rise_);
  varying_ = 0.5 * (varying_ + rise_);
  rise_ -= varying_;
  mean_ += varying_;
}

void StepLoads::evaluate(const SemidiscreteProblem& problem, const Vector& middle, const Vector& end,
                         bool has_contact_nodes) {
  if (follows_) {
    pressure_.setZero(middle.size());
    problem.pressure->add_mean_force(middle, start_time_, end_time_, pressure_);
  }
  if (!acts_at_ends() || !has_contact_nodes) return;
  at_end_ = rise_;
  if (follows_) problem.pressure->add_force(end, end_time_, at_end_);
}

double StepLoads::work_of_change(const std::vector<Index>& dofs, const Vector& start, const Vector& end,
                                 const Vector& middle) const {
  if (!acts_at_ends()) return 0.0;
  double sum = 0.0;
  for (const Index dof : dofs) {
    const double half_change = at_end_[dof] - (follows_ ? pressure_[dof] : 0.0);
    sum += 2.0 * half_change * (0.5 * (start[dof] + end[dof]) - middle[dof]);
  }
  return sum;
}

void StepLoads::store_varying(Vector& varying_load) const {
  if (varies_) varying_load = varying_;
  if (!follows_) return;
  if (varies_) {
    varying_load += pressure_;
  } else {
    varying_load = pressure_;
  }
}

}  // namespace ricochet
