#include "ricochet/scheme/response/contact_response.hpp"

#include <fmt/format.h>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/scheme/step_equations.hpp"

namespace ricochet {

const StageSolution& solve_with_forces(const SemidiscreteProblem& problem, const Vector& normal, std::size_t number,
                                       StageSolve& stages) {
  Stage& stage = stages.stage(number);
  stage.rows->add_force(normal, Vector(), stage.right_hand_side.force);
  stage.motion.reset();
  stage.conditions.eligible.assign(std::size_t(problem.contact.size()), 0);
  stage.conditions.gap.offset.setZero(problem.contact.size());
  stage.conditions.gap.rounding.setZero(problem.contact.size());
  stage.conditions.gap.factor = 1.0;
  stage.conditions.slip.offset.resize(0);
  return stages.solve(number);
}

void warn_of_dense_response(const std::string& scheme, Index rows) {
  constexpr Index many = 1000;
  if (rows <= many) return;
  log::warning(
      fmt::format("scheme \"{}\" stores a dense matrix of {} for each step length, {:.2g} GB, with one solve per row: "
                  "it is intended for a few hundred contact points; name only facets that may touch in the contact "
                  "group, or use scheme \"reduced-kane\"",
                  scheme, counted(rows, "row"), 8e-9 * double(rows) * double(rows)));
}

Vector point_stiffness(const SemidiscreteProblem& problem) {
  const SparseMatrix& k = problem.internal_force->tangent();
  Vector result = Vector::Zero(problem.contact.size());
  for (Index i = 0; i < result.size(); ++i) {
    double own = 0.0, length = 0.0;
    problem.contact.rows->visit_normal(i, [&](Index a, double at_a) {
      length += at_a * at_a;
      problem.contact.rows->visit_normal(i, [&](Index b, double at_b) { own += at_a * k.coeff(a, b) * at_b; });
    });
    if (length > 0.0) result[i] = own / (length * length);
  }
  return result;
}

const Vector& ContactResponse::column(const SemidiscreteProblem& problem, const ContactRows& rows, Index point,
                                      StageSolve& stages) {
  Vector& column = columns_[std::size_t(point)];
  if (column.size() > 0) return column;
  unloaded_stage(problem, number_, stages);
  unit_.setZero(problem.contact.size());
  unit_[point] = 1.0;
  rows.normal_motion(solve_with_forces(problem, unit_, number_, stages).increment, column);
  return column;
}

const Matrix& ContactResponse::among(const SemidiscreteProblem& problem, const ContactRows& rows,
                                     const std::vector<Index>& points, StageSolve& stages) {
  if (revision_ != rows.revision || columns_.empty()) {
    columns_.assign(std::size_t(problem.contact.size()), Vector());
    revision_ = rows.revision;
  }
  const auto count = Index(points.size());
  among_.resize(count, count);
  for (Index j = 0; j < count; ++j) {
    const Vector& whole = column(problem, rows, points[std::size_t(j)], stages);
    for (Index i = 0; i < count; ++i) among_(i, j) = whole[points[std::size_t(i)]];
  }
  return among_;
}

}  // namespace ricochet
