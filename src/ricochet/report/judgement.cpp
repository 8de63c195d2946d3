#include "ricochet/report/judgement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/simulation/history/history_columns.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"

namespace ricochet {

namespace {

/// Minimum number of rows on either side of one whose mean is the trend, and of rows for a meaningful trend.
constexpr std::size_t least_half = 5, least_rows = 50;
/// Relative variation below which a force counts as constant: the rest is rounding.
constexpr double constant = 1e-6;

double largest_magnitude(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

double total_variation(const std::vector<double>& values) {
  double sum = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) sum += std::abs(values[i] - values[i - 1]);
  return sum;
}

/// Returns the means over the rows around each one, `half` on either side if they exist.
std::vector<double> running_means(const std::vector<double>& values, std::size_t half) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t reach = std::min({half, i, values.size() - 1 - i});
    result[i] = (sums[i + reach + 1] - sums[i - reach]) / double(2 * reach + 1);
  }
  return result;
}

/// Returns the first time at which one of these columns is not finite.
std::optional<double> broken_at(const RunData& run, const std::vector<std::string>& columns) {
  std::optional<double> first;
  for (const std::string& column : columns) {
    const std::vector<double>& values = run.column(column);
    const auto bad = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
    if (bad == values.end()) continue;
    const double time = run.times_of(column)[std::size_t(bad - values.begin())];
    if (!first || time < *first) first = time;
  }
  return first;
}

/// Returns the energy that the time discretization has added, row by row.
std::vector<double> energy_of_method(const RunData& run) {
  std::vector<double> result = run.column("contact_work");
  const std::vector<double>& dissipated = run.column("numerical_dissipation");
  const std::vector<double>& algorithmic = run.column("algorithmic_energy");
  for (std::size_t i = 0; i < result.size(); ++i) result[i] -= dissipated[i] + (algorithmic[i] - algorithmic.front());
  return result;
}

void judge_energy(const RunData& run, Judgement& result) {
  const std::vector<double>& total = run.column("total_energy");
  if (total.empty()) return;
  const std::vector<double>&kinetic = run.column("kinetic_energy"), &elastic = run.column("elastic_energy");
  double most = 0.0;
  for (std::size_t i = 0; i < total.size(); ++i) most = std::max(most, kinetic[i] + elastic[i]);
  result.energy_scale = std::max(std::abs(total.front()), kinetic.front() + elastic.front());
  result.is_isolated = true;
  for (const std::string& work : column_names_of(ColumnGroup::work))
    result.is_isolated = result.is_isolated && (work == "contact_work" || largest_magnitude(run.column(work)) == 0.0);
  // If only contact acts, even a small initial energy is the reference, as any growth was created.
  if (!(result.energy_scale > (result.is_isolated ? 0.0 : 1e-12 * most))) result.energy_scale = most;
  const std::vector<double> changing = result.is_isolated ? total : energy_of_method(run);
  const auto [least, largest] = std::ranges::minmax_element(changing);
  result.energy_gain = *largest - changing.front();
  result.energy_loss = changing.front() - *least;
  result.energy_change = changing.back() - changing.front();
  result.energy_residual = largest_magnitude(run.column("energy_residual"));
}

/// Returns the columns of the components of a vector.
std::vector<std::string> components_of(const RunData& run, const std::string& name) {
  std::vector<std::string> result;
  for (const char* const axis : {"_x", "_y", "_z"}) {
    if (run.has_column(name + axis)) result.push_back(name + axis);
  }
  return result;
}

double largest_magnitude(const RunData& run, const std::vector<std::string>& columns) {
  double result = 0.0;
  for (const std::string& column : columns) result = std::max(result, largest_magnitude(run.column(column)));
  return result;
}

/// Returns the columns of the force that is judged: the one on obstacles, or the one between two bodies if larger.
std::vector<std::string> force_columns(const RunData& run) {
  std::vector<std::string> best = components_of(run, "contact_force");
  for (std::size_t i = 0; i < run.summary.contacts.size(); ++i) {
    const std::vector<std::string> pair = components_of(run, fmt::format("pair_force.{}", i));
    if (largest_magnitude(run, pair) > largest_magnitude(run, best)) best = pair;
  }
  return best;
}

/// Returns the component of the resultant with the largest magnitude.
std::string resultant_column(const RunData& run) {
  std::string best = "contact_force_x";
  for (const std::string& column : force_columns(run)) {
    if (!run.has_column(best) || largest_magnitude(run.column(column)) > largest_magnitude(run.column(best)))
      best = column;
  }
  return best;
}

struct Variation {
  double force = 0.0, trend = 0.0, roughness = 0.0;
};

Variation variation_of(const std::vector<double>& force) {
  const double largest = largest_magnitude(force);
  const std::size_t half = std::max<std::size_t>(force.size() / 200, least_half);
  Variation result{total_variation(force), total_variation(running_means(force, half)), 0.0};
  if (!(largest > 0.0)) return result;
  if (result.force < constant * largest) {
    result.roughness = 1.0;
  } else if (force.size() >= least_rows && result.trend > 0.0) {
    result.roughness = result.force / result.trend;
  }
  return result;
}

void judge_force(const RunData& run, Judgement& result) {
  const std::vector<std::string> columns = force_columns(run);
  result.force = resultant_column(run);
  const std::vector<double>& force = run.column(result.force);
  const std::vector<double>& times = run.times_of(result.force);
  for (std::size_t i = 0; i < force.size(); ++i) {
    double length = 0.0;
    for (const std::string& column : columns) length = std::hypot(length, run.column(column)[i]);
    if (!(length > result.force_largest)) continue;
    result.force_largest = length;
    result.force_largest_at = times[i];
  }
  const Variation variation = variation_of(force);
  result.force_variation = variation.force;
  result.trend_variation = variation.trend;
  result.roughness = variation.roughness;
  if (const Probe* probe = run.contact_probe()) {
    result.node_force = probe->name + ".reaction_normal";
    result.node_roughness = variation_of(run.column(result.node_force)).roughness;
  }
}

/// Finds the deepest penetration, at contact points or where no contact is defined.
void judge_penetration(const RunData& run, Judgement& result) {
  result.penetration = largest_magnitude(run.column("max_penetration"));
  if (run.results) {
    const Points& nodes = run.results->nodes();
    const double size = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
    if (size > 0.0) result.relative_penetration = result.penetration / size;
  }
  const PenetrationReport& report = run.summary.penetration;
  result.penetration_not_watched = fmt::format("{}", fmt::join(report.not_watched, ", "));
  if (!report.rims.empty()) result.contact_beyond_rim = report.rims.front().group;
  const UnwatchedPenetration* deepest = report.deepest();
  if (deepest == nullptr) return;
  result.penetration = std::max(result.penetration, deepest->depth);
  result.relative_penetration = std::max(result.relative_penetration.value_or(0.0), deepest->relative_depth);
  result.unwatched_penetration = deepest->is_self_penetration() ? deepest->bodies[0] + " in itself"
                                 : deepest->obstacle.empty()    ? deepest->bodies[0] + " and " + deepest->bodies[1]
                                                             : deepest->bodies[0] + " in \"" + deepest->obstacle + "\"";
}

/// Returns the limit of rotation for an impact. The error of its restitution is proportional to the square of the
/// body's rotation.
double rotation_limit_of(std::size_t number, const RunSummary& summary) {
  const Impact& impact = summary.impacts[number];
  if (!is_distorted_by_rotation(impact)) return std::numeric_limits<double>::infinity();
  const std::vector<double>& known = summary.rotation.until_impact_end;
  const double rotation = number < known.size() ? known[number] : summary.digest("max_rotation").maximum;
  return rotation * std::sqrt(restitution_excess_limit / std::abs(restitution_excess(impact)));
}

}  // namespace

Judgement judge(const RunData& run) {
  Judgement result;
  result.energy_broken_at =
      broken_at(run, {"total_energy", "kinetic_energy", "elastic_energy", "contact_work", "numerical_dissipation"});
  judge_energy(run, result);
  judge_force(run, result);
  std::vector<std::string> forces{result.force};
  for (const std::string& column : force_columns(run)) forces.push_back(column);
  if (!result.node_force.empty()) forces.push_back(result.node_force);
  result.force_broken_at = broken_at(run, forces);
  result.penetration_broken_at = broken_at(run, {"max_penetration"});
  judge_penetration(run, result);
  const bool has_rotation = !broken_at(run, {"max_rotation"});
  result.rotation =
      has_rotation ? largest_magnitude(run.column("max_rotation")) : std::numeric_limits<double>::quiet_NaN();
  result.rotation_limit = run.summary.rotation.limit;
  for (std::size_t i = 0; i < run.summary.impacts.size(); ++i)
    result.rotation_limit = std::min(result.rotation_limit, rotation_limit_of(i, run.summary));
  result.rotation_after_impacts =
      result.rotation > result.rotation_limit && run.summary.small_strain_holds_in_impacts();
  return result;
}

}  // namespace ricochet
