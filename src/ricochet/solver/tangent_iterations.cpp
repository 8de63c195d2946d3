#include "ricochet/solver/tangent_iterations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

TangentIterations::TangentIterations(const SemidiscreteProblem& problem, const ContactThresholds& thresholds)
    : problem_(problem), thresholds_(thresholds) {
  if (!problem.ranks->are_several()) return;
  Vector is_counted(static_cast<Index>(problem.contact_dofs.size()));
  for (Index i = 0; i < is_counted.size(); ++i) {
    const Index node = problem.contact_dofs[std::size_t(i)] / problem.dimension;
    is_counted[i] = problem.ranks->is_owned(node) ? 1.0 : 0.0;
  }
  acceleration_.distribute(*problem.ranks, std::move(is_counted));
}

void TangentIterations::follow_motion(StageSolver& solver, Stage& stage, StageSolution& solution) {
  int iterations = solution.iterations, last_progress = 0, last_start = 0;
  double best_error = std::numeric_limits<double>::infinity();
  linearized_at_.setZero(problem_.dof_count());  // no motion before the first iteration
  for (int iteration = 0;; ++iteration) {
    const LinearizationError remaining = linearization_error(problem_, solution, stage, gap_);
    // Iterations that settle by themselves do so to the rounding of the gaps.
    const double error =
        iteration <= thresholds_.plain_iterations ? remaining.beyond_rounding : remaining.beyond_all_rounding;
    if (log::enabled(log::Level::debug) && iteration > 0)
      log::debug(fmt::format("contact that rotates: iteration {}, gaps wrong by {:.2e}", iteration, error));
    if (error <= 0.0) break;
    if (error < thresholds_.progress * best_error) {
      best_error = error;
      last_progress = iteration;
    }
    const bool is_last =
        iteration == thresholds_.max_iterations || iteration - last_progress > thresholds_.max_stalled_iterations;
    const Vector& rounding = stage.conditions.gap.rounding;
    const double of_rounding = error / problem_.ranks->maximum(rounding.size() > 0 ? rounding.maxCoeff() : 0.0);
    if (iteration >= thresholds_.rounding_iterations && iteration - last_progress >= thresholds_.max_stalled_rounding &&
        of_rounding <= thresholds_.max_rounding)
      break;
    if (iteration >= thresholds_.last_iterations && of_rounding <= thresholds_.max_last_rounding) break;
    // Pairs change from iteration to iteration: they are held, and the next iteration solves the then linear
    // conditions.
    const bool is_stuck = iteration - last_progress > thresholds_.max_stalled_pairs || !std::isfinite(error) ||
                          iteration == thresholds_.max_iterations;
    if (is_stuck && problem_.contact.freeze_pairs()) {
      best_error = std::numeric_limits<double>::infinity();
      last_progress = last_start = iteration;
      acceleration_.restart();
      linearize_contact(problem_, linearized_at_, stage);
      solver.solve(stage.linear(), solution);
      iterations += solution.iterations;
      continue;
    }
    if (is_last || !std::isfinite(error)) {
      throw Error(ErrorKind::not_converged,
                  fmt::format("the contact forces, which rotate with the surfaces that the bodies touch, did not "
                              "converge in {} iterations (the gaps are still wrong by {:.3g})",
                              iteration, best_error));
    }
    if (iteration == thresholds_.plain_iterations ||
        iteration - std::max(last_progress, last_start) > thresholds_.max_stalled_acceleration) {
      acceleration_.restart();
      last_start = iteration;
    }
    linearize_at(solution.contact_motion(), iteration > thresholds_.plain_iterations);
    linearize_contact(problem_, linearized_at_, stage);
    solver.solve(stage.linear(), solution);
    iterations += solution.iterations;
  }
  solution.iterations = iterations;
}

/// Sets the point of linearization, which does not matter away from the contact.
void TangentIterations::linearize_at(const Vector& increment, bool accelerate) {
  if (!accelerate) {
    linearized_at_ = increment;
    return;
  }
  point_.resize(Index(problem_.contact_dofs.size()));
  image_.resize(point_.size());
  problem_.gather_contact(linearized_at_, point_);
  problem_.gather_contact(increment, image_);
  acceleration_.advance(point_, image_, image_);
  linearized_at_ = increment;
  problem_.scatter_contact(image_, linearized_at_);
}

}  // namespace ricochet
