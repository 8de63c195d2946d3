#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/case_run.hpp"
#include "support/closed_forms.hpp"
#include "support/strip.hpp"

// Bars and a rod whose motion has a closed form: errors in displacement, velocity, stress and contact pressure, and
// their observed orders when h and Δt are refined together. The fields have kinks and jumps, so low orders are right.

namespace ricochet::test_support::exact_bars_test {

/// Exact fields at a point of the undeformed bar and an instant.
struct Exact {
  std::function<double(double x, double t)> displacement, velocity, stress;
  std::function<double(double t)> pressure;  ///< at x = 0
};

struct Problem {
  std::string name;
  double x0, length, young, density, speed, end;
  std::string toml;  ///< loads, initial state and right end
  Exact exact;
  std::vector<std::pair<double, double>> contacts;  ///< begin and end
};

double heaviside(double r) { return r > 0.0 ? 1.0 : 0.0; }

/// E = 900, ρ = 1, L = 10, gap 5, v = −10: contact on [1/2, 7/6] under the pressure ρcv = 300, then a uniform rebound
/// at +10.
Problem impact() {
  const double c = 30.0, L = 10.0, v = 10.0;
  // In contact the end is at rest: u = −5 − v s + F(s − x/c) + F(s − (2L−x)/c), F(r) = v r H(r), s = t − 1/2 ≥ 0;
  // afterwards the two waves have crossed the bar and the formula describes the rebound.
  Exact exact;
  exact.displacement = [=](double x, double t) {
    const double s = std::max(t - 0.5, 0.0);
    const double first = s - x / c, second = s - (2.0 * L - x) / c;
    return -v * t + v * first * heaviside(first) + v * second * heaviside(second);
  };
  exact.velocity = [=](double x, double t) {
    const double s = t - 0.5;
    return -v + v * heaviside(s - x / c) + v * heaviside(s - (2.0 * L - x) / c);
  };
  exact.stress = [=](double x, double t) {
    const double s = t - 0.5;
    return 900.0 * v / c * (heaviside(s - (2.0 * L - x) / c) - heaviside(s - x / c));
  };
  exact.pressure = [](double t) { return t > 0.5 && t < 7.0 / 6.0 ? 300.0 : 0.0; };
  return {"impact", 5.0, L, 900.0, 1.0, c, 1.6, "[initial]\nvelocity = [-10.0, 0.0]\n", exact, {{0.5, 7.0 / 6.0}}};
}

/// A bar like that of impact(), dropped from rest with g = 10. Its period is 16/3; the second contact is the time
/// reverse of the first.
Problem bounce() {
  const double c = 30.0, L = 10.0, v = 10.0, g = 10.0;
  const auto wave = [=](double r) { return r > 0.0 ? v * r + 0.5 * g * r * r : 0.0; };
  const auto wave_rate = [=](double r) { return r > 0.0 ? v + g * r : 0.0; };
  Exact exact;  // up to the end of the first contact, t = 5/3
  exact.displacement = [=](double x, double t) {
    const double s = t - 1.0;
    return s <= 0.0 ? -0.5 * g * t * t : -5.0 - v * s - 0.5 * g * s * s + wave(s - x / c) + wave(s - (2.0 * L - x) / c);
  };
  exact.velocity = [=](double x, double t) {
    const double s = t - 1.0;
    return s <= 0.0 ? -g * t : -v - g * s + wave_rate(s - x / c) + wave_rate(s - (2.0 * L - x) / c);
  };
  exact.stress = [=](double x, double t) {
    const double s = t - 1.0;
    return 900.0 / c * (wave_rate(s - (2.0 * L - x) / c) - wave_rate(s - x / c));
  };
  exact.pressure = [](double t) { return t > 1.0 && t < 5.0 / 3.0 ? 30.0 * (10.0 + 10.0 * (t - 1.0)) : 0.0; };
  return {"bounce", 5.0, L, 900.0, 1.0, c, 5.0 / 3.0, "[load]\ngravity = [-10.0, 0.0]\n", exact, {{1.0, 5.0 / 3.0}}};
}

/// E = ρ = L = 1, right end fixed, compressed by ½ − x/2 and released. Period 3; contact stress ½ on [1, 2].
Problem rod() {
  // The closed form holds for the end at x = 0; the fields inside are omitted.
  Exact exact;
  const auto end_position = [](double t) {
    const double s = std::fmod(t, 3.0);
    return s < 1.0 ? 0.5 - 0.5 * s : s < 2.0 ? 0.0 : 0.5 * (s - 2.0);
  };
  exact.displacement = [=](double x, double t) { return x == 0.0 ? end_position(t) : NAN; };
  exact.pressure = [](double t) {
    const double s = std::fmod(t, 3.0);
    return s > 1.0 && s < 2.0 ? 0.5 : 0.0;
  };
  return {"rod",
          0.0,
          1.0,
          1.0,
          1.0,
          1.0,
          6.0,
          "[[support]]\ngroup = \"right\"\ncomponents = [\"x\"]\nvalue = 0.0\n[initial]\ndisplacement = "
          "[\"0.5-0.5*x\", \"0\"]\n",
          exact,
          {{1.0, 2.0}, {4.0, 5.0}}};
}

struct Errors {
  double displacement = 0.0, velocity = 0.0, stress = 0.0, pressure = 0.0;
  std::vector<std::pair<double, double>> contacts;
  double step = 0.0;
  double energy_change = 0.0;  ///< largest |J − J(0)| relative to the largest kinetic or elastic energy
  double end_velocity = 0.0;   ///< of the centre of gravity
};

constexpr const char* trapezoidal =
    "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\n";
constexpr const char* kane_end =
    "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"reduced-kane\"\nreaction_weight = \"end\"\n";
constexpr const char* kane = "[mass]\ntype = \"equivalent\"\n[time]\n";  // the default
constexpr const char* mean_reaction = "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"mean-reaction\"\n";
constexpr const char* reduced_midpoint = "[mass]\ntype = \"equivalent\"\n[time]\nscheme = \"reduced-midpoint\"\n";
constexpr const char* semi_explicit = "[mass]\ntype = \"equivalent-lumped\"\n[time]\nscheme = \"semi-explicit\"\n";

/// Runs a problem on `cells` cells with Δt = ½ h/c. Errors are relative L² norms over the bar and time (displacement of
/// the contact end alone if the closed form is known only there).
Errors solve(const Problem& problem, int cells, int degree, bool triangles, const char* scheme = trapezoidal) {
  const double h = problem.length / cells;
  const double step = 0.5 * h / problem.speed;
  CaseRun run(
      strip_case(strip_mesh(problem.x0, problem.length, cells, triangles), problem.young, problem.density, degree) +
      problem.toml + scheme + fmt::format("step = {:.17g}\nend = {:.17g}\n", step, problem.end));
  const Points& nodes = run.problem().nodes;
  std::vector<Index> lower;  // the nodes of the lower side, in order of x
  for (Index i = 0; i < nodes.cols(); ++i) {
    if (nodes(1, i) == 0.0) lower.push_back(i);
  }
  std::ranges::sort(lower, [&](Index a, Index b) { return nodes(0, a) < nodes(0, b); });
  Errors e;
  e.step = step;
  double size[4] = {0.0, 0.0, 0.0, 0.0};
  double error[4] = {0.0, 0.0, 0.0, 0.0};
  const auto add = [&](int k, double found, double exact, double weight) {
    error[k] += weight * (found - exact) * (found - exact);
    size[k] += weight * exact * exact;
  };
  bool touching = false;
  double first_energy = 0.0, largest_energy = 0.0, largest_change = 0.0;
  run.run([&] {
    const State& state = run.state();
    const double t = state.time;
    const Energies energies = run.simulation().account().energies(state);
    if (state.step == 0) first_energy = energies.total();
    largest_energy = std::max({largest_energy, energies.kinetic, energies.elastic});
    largest_change = std::max(largest_change, std::abs(energies.total() - first_energy));
    e.end_velocity = (run.problem().mass.to_sparse() * state.velocity).sum() / (problem.density * problem.length * h);
    const double force = state.forces.normal_reaction.sum();
    add(3, force / run.problem().contact.weights.sum(), problem.exact.pressure(t), step);
    if ((force > 0.0) != touching) {
      touching = force > 0.0;
      if (touching) e.contacts.emplace_back(t, t);
    }
    if (touching) e.contacts.back().second = t;
    if (!problem.exact.velocity) {
      add(0, state.displacement[2 * lower.front()], problem.exact.displacement(0.0, t), step);
      return;
    }
    for (std::size_t i = 0; i + 1 < lower.size(); ++i) {
      const double xa = nodes(0, lower[i]) - problem.x0, xb = nodes(0, lower[i + 1]) - problem.x0;
      const double middle = 0.5 * (xa + xb);
      const double ua = state.displacement[2 * lower[i]], ub = state.displacement[2 * lower[i + 1]];
      const double va = state.velocity[2 * lower[i]], vb = state.velocity[2 * lower[i + 1]];
      const double weight = step * (xb - xa);
      add(0, 0.5 * (ua + ub), problem.exact.displacement(middle, t), weight);
      add(1, 0.5 * (va + vb), problem.exact.velocity(middle, t), weight);
      add(2, problem.young * (ub - ua) / (xb - xa), problem.exact.stress(middle, t), weight);
    }
  });
  const auto relative = [&](int k) { return size[k] > 0.0 ? std::sqrt(error[k] / size[k]) : 0.0; };
  e.energy_change = largest_change / largest_energy;
  e.displacement = relative(0);
  e.velocity = relative(1);
  e.stress = relative(2);
  e.pressure = relative(3);
  return e;
}

double order(double coarse, double fine) { return fine > 0.0 ? std::log2(coarse / fine) : 0.0; }

/// Scheme and parameters in `[time]`, on one line.
std::string scheme_name(const std::string& text) {
  const std::size_t begin = text.find("scheme");
  std::string name = begin == std::string::npos ? "reduced-kane" : text.substr(begin);
  std::ranges::replace(name, '\n', ' ');
  return name;
}

/// Prints the table of a problem and returns the errors by refinement.
std::vector<Errors> table(const Problem& problem, const std::vector<int>& cells, int degree, bool triangles,
                          const char* scheme = trapezoidal) {
  std::vector<Errors> all;
  std::printf("%s, %s, degree %d, %s, dt = h/2c\n", problem.name.c_str(), triangles ? "triangles" : "quadrilaterals",
              degree, scheme_name(scheme).c_str());
  std::printf("%6s %18s %18s %18s %18s  %s\n", "cells", "displacement", "velocity", "stress", "pressure",
              "contacts (in steps from the exact times)");
  for (const int n : cells) {
    all.push_back(solve(problem, n, degree, triangles, scheme));
    const Errors& e = all.back();
    const Errors* before = all.size() > 1 ? &all[all.size() - 2] : nullptr;
    const auto cell = [&](double Errors::*part) {
      return fmt::format(
          "{:10.2e} {:>7}", e.*part,
          before != nullptr && e.*part > 0.0 ? fmt::format("{:.2f}", order(before->*part, e.*part)) : "");
    };
    std::string times;
    for (std::size_t i = 0; i < e.contacts.size() && i < problem.contacts.size(); ++i) {
      times += fmt::format(" [{:+.2f}, {:+.2f}]", (e.contacts[i].first - problem.contacts[i].first) / e.step,
                           (e.contacts[i].second - problem.contacts[i].second) / e.step);
    }
    std::printf("%6d %s %s %s %s %s (%zu)\n", n, cell(&Errors::displacement).c_str(), cell(&Errors::velocity).c_str(),
                cell(&Errors::stress).c_str(), cell(&Errors::pressure).c_str(), times.c_str(), e.contacts.size());
    std::printf("       energy change %.2e\n", e.energy_change);
  }
  return all;
}

/// Mean observed order from the coarsest to the finest mesh.
double mean_order(const std::vector<Errors>& all, double Errors::*part) {
  return order(all.front().*part, all.back().*part) / double(all.size() - 1);
}

/// Contacts begin within one step of the exact time on every mesh. They end when the tail of the dispersed release wave
/// has passed, which is wider than a step on fine meshes (its width shrinks like h^(2/3), the step like h): within one
/// step up to 100 cells, and within the step of 100 cells on finer meshes.
void expect_contact_times(const Problem& problem, const std::vector<Errors>& all, const std::vector<int>& cells) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double wide = all[k].step * std::max(1.0, cells[k] / 100.0) * (1.0 + 1e-9);
    ASSERT_EQ(all[k].contacts.size(), problem.contacts.size()) << problem.name << " " << cells[k];
    for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
      EXPECT_NEAR(all[k].contacts[i].first, problem.contacts[i].first, all[k].step * (1.0 + 1e-9))
          << problem.name << " " << cells[k];
      EXPECT_NEAR(all[k].contacts[i].second, problem.contacts[i].second, wide) << problem.name << " " << cells[k];
    }
  }
}

/// With a lumped mass and central differences, waves of wave number k lag by c (kh)²(1−r²)/8 per time, r = cΔt/h, so a
/// front that has travelled x is (x h² (1−r²)/8)^⅓ wide: contacts end at most that much late, and not early.
void expect_late_releases(const Problem& problem, const std::vector<Errors>& all, const std::vector<int>& cells) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double h = problem.length / cells[k];
    ASSERT_EQ(all[k].contacts.size(), problem.contacts.size()) << problem.name << " " << cells[k];
    for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
      const auto [begin, end] = problem.contacts[i];
      const double width = std::cbrt(problem.speed * end * h * h * (1.0 - 0.25) / 8.0) / problem.speed;
      EXPECT_NEAR(all[k].contacts[i].first, begin, all[k].step * (1.0 + 1e-9)) << problem.name << " " << cells[k];
      EXPECT_GT(all[k].contacts[i].second, end - all[k].step) << problem.name << " " << cells[k];
      EXPECT_LT(all[k].contacts[i].second, end + all[k].step + width) << problem.name << " " << cells[k];
    }
  }
}

/// The rebound is uniform at +10 apart from oscillations behind the fronts, which vanish with h.
void expect_rebound(const std::vector<Errors>& all) {
  for (std::size_t k = 1; k < all.size(); ++k) {
    EXPECT_LT(10.0 - all[k].end_velocity, 10.0 - all[k - 1].end_velocity);
  }
  EXPECT_LT(std::abs(10.0 - all.back().end_velocity), 0.15);
}

TEST(ExactBars, HaveTheClosedFormsOfTheBenchmarks) {
  for (const Problem& problem : {impact(), bounce(), rod()}) {
    const Exact& exact = problem.exact;
    for (const auto& [quantity, x, time, value] : closed_forms(problem.name)) {
      const double found = quantity == "pressure"   ? exact.pressure(time)
                           : quantity == "velocity" ? exact.velocity(x, time)
                                                    : exact.displacement(x, time);
      EXPECT_NEAR(found, value, 1e-10 * std::max(1.0, std::abs(value)))
          << problem.name << ' ' << quantity << ' ' << time;
    }
  }
}

TEST(ExactBars, ImpactWithoutGravity) {
  for (const bool triangles : {false, true}) {
    const std::vector<int> cells{25, 50, 100, 200};
    const Problem problem = impact();
    const std::vector<Errors> all = table(problem, cells, 1, triangles);
    EXPECT_GT(mean_order(all, &Errors::displacement), 0.6);
    EXPECT_GT(mean_order(all, &Errors::velocity), 0.3);
    EXPECT_GT(mean_order(all, &Errors::stress), 0.3);
    EXPECT_GT(mean_order(all, &Errors::pressure), 0.2);
    EXPECT_LT(all.back().pressure, 0.09);
    EXPECT_LT(all.back().displacement, 1e-3);
    expect_rebound(all);
    expect_contact_times(problem, all, cells);
  }
}

TEST(ExactBars, ImpactWithDegreeTwo) {
  const std::vector<Errors> all = table(impact(), {25, 50, 100}, 2, false);
  EXPECT_GT(mean_order(all, &Errors::displacement), 0.6);
  EXPECT_GT(mean_order(all, &Errors::pressure), 0.3);
  expect_rebound(all);
}

TEST(ExactBars, FirstBounceWithGravity) {
  const std::vector<int> cells{25, 50, 100, 200};
  const Problem problem = bounce();
  const std::vector<Errors> all = table(problem, cells, 1, false);
  EXPECT_GT(mean_order(all, &Errors::displacement), 0.9);
  EXPECT_GT(mean_order(all, &Errors::velocity), 0.3);
  EXPECT_GT(mean_order(all, &Errors::stress), 0.3);
  EXPECT_GT(mean_order(all, &Errors::pressure), 0.25);
  EXPECT_LT(all.back().energy_change, 1e-3);
  expect_contact_times(problem, all, cells);
}

TEST(ExactBars, SemiExplicit) {
  for (const Problem& problem : {impact(), bounce(), rod()}) {
    const std::vector<int> cells{25, 50, 100, 200};
    const std::vector<Errors> all = table(problem, cells, 1, false, semi_explicit);
    EXPECT_GT(mean_order(all, &Errors::displacement), 0.6);
    EXPECT_GT(mean_order(all, &Errors::pressure), 0.2);
    EXPECT_LT(all.back().energy_change, 5e-3);
    expect_late_releases(problem, all, cells);
  }
}

TEST(ExactBars, ReducedSchemes) {
  for (const Problem& problem : {impact(), bounce(), rod()}) {
    const std::vector<int> cells{25, 50, 100, 200};
    const std::vector<Errors> newmark = table(problem, cells, 1, false);
    for (const char* const scheme : {kane_end, kane, mean_reaction, reduced_midpoint}) {
      const std::vector<Errors> all = table(problem, cells, 1, false, scheme);
      const std::string name = problem.name + scheme;
      EXPECT_GT(mean_order(all, &Errors::displacement), 0.6) << name;
      EXPECT_GT(mean_order(all, &Errors::pressure), 0.2) << name;
      // At most slightly farther from the closed form than the trapezoidal rule.
      EXPECT_LT(all.back().displacement, 1.5 * newmark.back().displacement) << name;
      EXPECT_LT(all.back().pressure, 1.3 * newmark.back().pressure) << name;
      expect_contact_times(problem, all, cells);
      const bool is_exact = scheme == mean_reaction || scheme == kane;  // at half a crossing the default has μ = 0
      EXPECT_LT(all.back().energy_change, is_exact ? 1e-11 : 1e-2) << name;
      if (scheme == kane_end) {
        EXPECT_GT(order(all.front().energy_change, all.back().energy_change) / 3.0, 0.9) << name;
      }
    }
  }
}

TEST(ExactBars, BouncingIsPeriodic) {
  Problem problem = bounce();
  problem.end = 7.5;
  problem.exact.velocity = nullptr;  // only times are compared
  problem.exact.displacement = [](double, double) { return 0.0; };
  problem.contacts = {{1.0, 5.0 / 3.0}, {11.0 / 3.0, 13.0 / 3.0}, {19.0 / 3.0, 7.0}};
  // Each bounce leaves small oscillations in the mesh, so later flights are slightly short: the times converge with h.
  double last_worst = 1.0;
  for (const int cells : {50, 100, 200, 400}) {
    const Errors found = solve(problem, cells, 1, false);
    ASSERT_EQ(found.contacts.size(), 3u) << cells;
    double worst = 0.0;
    std::printf("bounces, %3d cells:", cells);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [begin, end] = found.contacts[i];
      std::printf(" [%.4f, %.4f]", begin, end);
      worst =
          std::max({worst, std::abs(begin - problem.contacts[i].first), std::abs(end - problem.contacts[i].second)});
    }
    std::printf("  worst %.4f, energy change %.1e\n", worst, found.energy_change);
    EXPECT_LT(worst, last_worst) << cells;
    EXPECT_LT(found.energy_change, 2e-3);
    last_worst = worst;
  }
  EXPECT_LT(last_worst, 0.002 * problem.contacts.back().second);
}

TEST(ExactBars, CompressedRod) {
  const std::vector<int> cells{25, 50, 100, 200};
  const Problem problem = rod();
  const std::vector<Errors> all = table(problem, cells, 1, false);
  EXPECT_GT(mean_order(all, &Errors::displacement), 0.7);
  EXPECT_GT(mean_order(all, &Errors::pressure), 0.3);
  EXPECT_LT(all.back().energy_change, 5e-3);
  expect_contact_times(problem, all, cells);
  EXPECT_GT(mean_order(table(problem, {25, 50, 100}, 2, false), &Errors::displacement), 0.6);
}

}  // namespace ricochet::test_support::exact_bars_test
