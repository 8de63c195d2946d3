#include "ricochet/run/run_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/run/run_judgement.hpp"
#include "ricochet/simulation/history/history.hpp"

namespace ricochet {

/// Rounding of a sum of works, relative to the largest work.
constexpr double rounding_of_works = 1e-12;
/// Rounding of momenta, relative to √(2 m T).
constexpr double rounding_of_momenta = 1e-12;

RunChecks::RunChecks(const Case& input, const Model& model, const Scheme& scheme, const State& state,
                     const std::vector<std::string>& columns)
    : model_(model),
      stops_(input.check.stops),
      momentum_(model.problem, scheme, state),
      kinetic_(column_index(columns, "kinetic_energy")),
      elastic_(column_index(columns, "elastic_energy")),
      total_(column_index(columns, "total_energy")),
      residual_(column_index(columns, "energy_residual")),
      momentum_column_(column_index(columns, "momentum_x")),
      angular_column_(
          column_index(columns, model.problem.dimension == 2 ? "angular_momentum_z" : "angular_momentum_x")) {
  for (const std::string& work : column_names_of(ColumnGroup::work)) works_.push_back(column_index(columns, work));
  const auto of_bodies = [](const std::string& column) { return column.starts_with("momentum."); };
  const auto first = std::ranges::find_if(columns, of_bodies);
  body_momenta_ = std::size_t(first - columns.begin());
  body_momenta_end_ = body_momenta_ + std::size_t(std::count_if(first, columns.end(), of_bodies));
  Vector inertia;
  model.problem.mass.multiply(Vector::Ones(model.problem.mass.size()), inertia);
  mass_ = model.problem.ranks->sum(inertia.sum()) / model.problem.dimension;
  const std::string solver =
      input.solver.method == "direct" ? "" : ", or solver.tolerance if steps are solved by iterations";
  energy_.result.name = "energy_residual";
  energy_.result.limit = input.check.energy_residual;
  energy_.advice = linear_.advice = angular_.advice =
      "stiffnesses or densities that differ by many orders of magnitude, a Poisson's ratio at 1/2 or an extreme "
      "time.step "
      "are likely causes" +
      solver + "; do not trust more digits of this run than that";
  linear_.result.name = "momentum";
  linear_.result.limit = input.check.momentum;
  angular_.result.name = "angular_momentum";
  angular_.result.limit = input.check.angular_momentum;
  // The shape functions of degree 1 on curved cells do not contain rotations.
  if (!model.contains_rotations) angular_.result.limit = 0.0;
  if (!model.problem.internal_force->is_linear() && !scheme.traits().conserves_moments_at_finite_strain)
    angular_.result.limit = 0.0;
}

void RunChecks::persist(const SnapshotVisitor& visit) {
  momentum_.persist(visit.part("impulse"));
  visit.numbers("state", start_, energy_scale_, momentum_scale_, ignored_scale_, energy_.result.largest,
                linear_.result.largest, angular_.result.largest, has_start_, work_scale_);
  visit.integers("told", {0, 1}, energy_.warned, linear_.warned, angular_.warned);
}

double RunChecks::size_of_momenta(const std::vector<double>& row, const Resultant& all) const {
  double sum = 0.0;
  const auto d = std::size_t(model_.problem.dimension);
  for (std::size_t first = body_momenta_; first + d <= body_momenta_end_; first += d)
    sum += Eigen::Map<const Vector>(row.data() + first, Index(d)).norm();
  return std::max(sum, all.force.norm());
}

/// Returns the larger limit of the two balances of momentum; 1 if neither is checked.
double RunChecks::largest_limit() const {
  const double limit = std::max(linear_.result.limit, angular_.result.limit);
  return limit > 0.0 ? limit : 1.0;
}

Resultant RunChecks::momentum(const std::vector<double>& row) const {
  Resultant result;
  const auto d = std::size_t(model_.problem.dimension);
  for (std::size_t k = 0; k < d; ++k) result.force[Index(k)] = row[momentum_column_ + k];
  if (d == 2) {
    result.moment[2] = row[angular_column_];
  } else {
    for (std::size_t k = 0; k < d; ++k) result.moment[Index(k)] = row[angular_column_ + k];
  }
  return result;
}

void RunChecks::watch(const std::vector<double>& row, const State& state) {
  const Resultant now = momentum(row);
  if (!has_start_) {
    start_ = now;
    has_start_ = true;
  }
  energy_scale_ = std::max({energy_scale_, std::abs(row[total_]), std::abs(row[kinetic_]), std::abs(row[elastic_])});
  // Momenta of bodies that collide head-on cancel, their magnitudes do not. The momentum of a body that only spins or
  // vibrates is mere rounding, relative to √(2 m T), where T is the kinetic energy; no momentum of a part exceeds this.
  momentum_scale_ =
      std::max({momentum_scale_, size_of_momenta(row, now),
                rounding_of_momenta / largest_limit() * std::sqrt(2.0 * mass_ * std::max(row[kinetic_], 0.0))});
  // Forces between which a body is squeezed cancel in the resultants and leave rounding.
  const double momentum_scale =
      std::max(momentum_scale_ + momentum_.size(), rounding_of_momenta / largest_limit() * momentum_.contact_size());
  for (const std::size_t work : works_) work_scale_ = std::max(work_scale_, std::abs(row[work]));
  // Works that cancel leave rounding, below which no limit can be.
  const double rounding = energy_.result.limit > 0.0 ? rounding_of_works * work_scale_ / energy_.result.limit : 0.0;
  judge(energy_, std::abs(row[residual_]), std::max(energy_scale_, rounding), row, state);
  judge(linear_, (now.force - start_.force - momentum_.impulse().force).norm(), momentum_scale, row, state);
  judge(angular_, (now.moment - start_.moment - momentum_.impulse().moment).norm(), momentum_scale * momentum_.arm(),
        row, state);
}

void RunChecks::judge(Account& account, double residual, double scale, const std::vector<double>& row,
                      const State& state) {
  CheckResult& result = account.result;
  // Rounding is a large part of an energy that nearly vanishes, as when a load starts like exp(-t²).
  constexpr double least_scale = 1e-280;
  if (!(scale > least_scale)) return;
  const bool broken = result.limit > 0.0 && residual > result.limit * scale;
  if (broken && &account == &energy_ && !account.warned) {
    // Tested again only after the energy has grown tenfold, as the test takes as long as some steps.
    if (scale < 10.0 * ignored_scale_) return;
    if (is_rounding_of_energy(scale, model_.problem, state)) {
      ignored_scale_ = scale;
      return;
    }
  }
  result.largest = std::max(result.largest, residual / scale);
  if (!broken || account.warned) return;
  account.warned = true;
  const std::string what = &account == &energy_ ? "energy" : &account == &linear_ ? "momentum" : "angular momentum";
  const std::string message = fmt::format(
      "at t = {:.6g} (step {:.0f}) the balance of {} is violated by {:.2g} of the largest {}, more than "
      "check.{} = {:g}; {}",
      row[1], row[0], what, residual / scale, &account == &energy_ ? "energy" : what + " of the parts", result.name,
      result.limit, account.advice);
  if (stops_) throw Error(ErrorKind::not_converged, message);
  log::warning(message);
}

std::vector<CheckResult> RunChecks::results() const { return {energy_.result, linear_.result, angular_.result}; }

}  // namespace ricochet
