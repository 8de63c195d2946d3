#include "ricochet/report/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

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

/// Means over the rows around each one, `half` to either side where there are as many.
std::vector<double> running_means(const std::vector<double>& values, std::size_t half) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t reach = std::min({half, i, values.size() - 1 - i});
    result[i] = (sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1);
  }
  return result;
}

void judge_energy(const RunData& run, Judgement& result) {
  const std::vector<double>& total = run.column("total_energy");
  if (total.empty()) return;
  const std::vector<double>&kinetic = run.column("kinetic_energy"), &elastic = run.column("elastic_energy");
  double most = 0.0;
  for (std::size_t i = 0; i < total.size(); ++i) most = std::max(most, kinetic[i] + elastic[i]);
  result.energy_scale = std::max(std::abs(total.front()), kinetic.front() + elastic.front());
  if (!(result.energy_scale > 1e-12 * most)) result.energy_scale = most;
  result.is_isolated = true;
  for (const char* work : {"load_work", "friction_work", "support_work", "obstacle_work", "damping_work"})
    result.is_isolated = result.is_isolated && largest_magnitude(run.column(work)) == 0.0;
  const std::vector<double>& changing = result.is_isolated ? total : run.column("contact_work");
  const auto [least, largest] = std::minmax_element(changing.begin(), changing.end());
  result.energy_gain = *largest - changing.front();
  result.energy_loss = changing.front() - *least;
  result.energy_change = changing.back() - changing.front();
  result.energy_residual = largest_magnitude(run.column("energy_residual"));
}

/// The column in which a rattling force shows most.
std::string force_column(const RunData& run) {
  if (const Probe* probe = run.contact_probe()) return probe->name + ".reaction_normal";
  std::string best = "contact_force_x";
  for (const char* axis : {"contact_force_y", "contact_force_z"}) {
    if (run.has_column(axis) && largest_magnitude(run.column(axis)) > largest_magnitude(run.column(best))) best = axis;
  }
  return best;
}

void judge_force(const RunData& run, Judgement& result) {
  result.force = force_column(run);
  const std::vector<double>& force = run.column(result.force);
  if (force.empty()) return;
  result.force_largest = largest_magnitude(force);
  result.force_variation = total_variation(force);
  const std::size_t half = std::max<std::size_t>(force.size() / 200, 1);
  result.trend_variation = total_variation(running_means(force, half));
  if (result.trend_variation > 0.0) result.roughness = result.force_variation / result.trend_variation;
}

}  // namespace

Judgement judge(const RunData& run) {
  Judgement result;
  judge_energy(run, result);
  judge_force(run, result);
  result.penetration = largest_magnitude(run.column("max_penetration"));
  if (run.results) {
    const Points& nodes = run.results->nodes();
    const double size = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
    if (size > 0.0) result.relative_penetration = result.penetration / size;
  }
  return result;
}

}  // namespace ricochet
