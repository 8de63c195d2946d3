#include "ricochet/simulation/monitor/peak_stress.hpp"

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/cell_integration.hpp"

namespace ricochet {

/// Relative increase of the contact force, over that of the evaluated states, from which a state is evaluated.
constexpr double harder = 5e-3;

double evaluation_work(const Body& body) {
  double work = 0.0;
  for (const CellBlock& block : body.space->cells) {
    const int d = body.mesh->dimension, geometry = body.mesh->degree, degree = body.space->degree;
    double per_cell = d == 2 ? 70.0 : 120.0;
    if (!is_simplex(block.shape) || geometry > 1 || degree > 1) {
      const QuadratureRule rule = quadrature(block.shape, stiffness_quadrature_degree(block.shape, geometry, degree));
      const double per_point = d == 2 ? 60.0 + 6.0 * block.nodes_per_cell : 100.0 + 30.0 * block.nodes_per_cell;
      per_cell = double(rule.weights.size()) * per_point;
    }
    work += per_cell * double(block.size());
  }
  return work;
}

double step_work(Index dofs, std::size_t factor_entries) {
  constexpr double per_dof = 20.0;
  return 2.0 * double(factor_entries) + per_dof * double(dofs);
}

PeakStress::PeakStress(const Body& body, double step_work, const Ranks& ranks, std::unique_ptr<StressRaisers> raisers)
    : body_(body),
      ranks_(ranks),
      stress_(body),
      raisers_(std::move(raisers)),
      evaluations_per_step_(std::min(1.0, share * step_work / ranks.sum(evaluation_work(body)))) {}

void PeakStress::enter(const State& state, bool is_frame) {
  ++result_.states;
  // Half of the evaluations are regular; the others are saved until the contact force exceeds its previous maximum.
  since_evaluation_ += evaluations_per_step_ < 1.0 ? 0.5 * evaluations_per_step_ : 1.0;
  evaluation_budget_ += 0.5 * evaluations_per_step_;
  const double press = ranks_.sum(state.forces.normal_reaction.sum());
  const bool presses_harder = press > (1.0 + harder) * hardest_press_;
  if (is_frame || since_evaluation_ >= 1.0) {
    since_evaluation_ = 0.0;
  } else if (presses_harder && evaluation_budget_ >= 1.0) {
    evaluation_budget_ -= 1.0;
  } else {
    return;
  }
  hardest_press_ = std::max(hardest_press_, press);
  evaluate(state);
}

void PeakStress::enter_frame(const State& state) {
  if (last_evaluation_ != state.step) evaluate(state);
}

void PeakStress::evaluate(const State& state) {
  ++result_.evaluations;
  last_evaluation_ = state.step;
  const LargestOfCells largest = stress_.largest_von_mises(state.displacement, state.internal_strain);
  if (result_.cell >= 0 && !(largest.value > result_.von_mises)) return;
  result_.von_mises = std::max(0.0, largest.value);
  result_.cell = largest.cell;
  result_.time = state.time;
  result_.step = state.step;
  if (raisers_) result_.raised_by = raisers_->at(state, largest.cell);
}

void PeakStress::persist(const SnapshotVisitor& visit) {
  visit.numbers("", evaluations_per_step_, evaluation_budget_, since_evaluation_, hardest_press_, result_.von_mises,
                result_.time);
  auto raised_by = int(result_.raised_by);
  visit.integers("counts", {}, result_.step, result_.cell, result_.evaluations, result_.states, last_evaluation_,
                 raised_by);
  if (visit.loads() &&
      (result_.cell < -1 || result_.cell >= body_.mesh->cell_count() || raised_by < 0 || raised_by >= stress_raisers))
    throw Error(ErrorKind::invalid_input, "the checkpoint's largest stress does not belong to this mesh");
  result_.raised_by = static_cast<StressRaiser>(raised_by);
}

}  // namespace ricochet
