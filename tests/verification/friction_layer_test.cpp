#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/case_run.hpp"
#include "support/closed_forms.hpp"
#include "support/msh_text.hpp"

// An elastic layer that slides over a rough base until it sticks: base velocity, slip, time of sticking and traction,
// and their observed orders when h and Δt are refined together. Velocity and traction jump, so low orders are right.

namespace ricochet::test_support::friction_layer_test {

/// Height, density and speed of shear waves 1, first velocity 1 along x, free top, friction traction at most a = F p.
/// Waves carry v + τ downwards and v − τ upwards, so that D = v + τ arriving at the base is v − τ at the base two units
/// of time earlier, reflected at the top: D(t) = (v − τ)(t − 2), initially 1. While the base slides forwards, τ = a and
/// v = D − a, which lowers D by 2a for the next two units. It sticks if |D| ≤ a: v = 0, τ = D; D then only changes
/// sign.
struct Layer {
  double a;

  /// D in phase k: on [2k, 2k + 2].
  [[nodiscard]] double arriving(int k) const {
    const int sliding = std::min(k, phases());
    const double last = 1.0 - 2.0 * a * sliding;
    return (k - sliding) % 2 == 0 ? last : -last;
  }
  /// Number k* of phases in which the base slides.
  [[nodiscard]] int phases() const { return int(std::ceil((1.0 / a - 1.0) / 2.0 - 1e-12)); }
  [[nodiscard]] static int phase(double t) { return int(t / 2.0); }
  [[nodiscard]] double sticking_time() const { return 2.0 * phases(); }
  [[nodiscard]] double velocity(double t) const { return phase(t) < phases() ? arriving(phase(t)) - a : 0.0; }
  /// Traction of the base on the layer.
  [[nodiscard]] double traction(double t) const { return phase(t) < phases() ? -a : -arriving(phase(t)); }
  [[nodiscard]] double slip() const { return 2.0 * phases() * (1.0 - phases() * a); }
};

/// Writes a column [0, width] × [0, 1] of one row of `cells` rectangles as a .msh file; returns its path. Groups:
/// "body", "base" (y = 0), "top" and "sides": the long sides except for the lowest cell, so that a support of the sides
/// leaves the nodes of the base free.
std::string column_mesh(double width, int cells) {
  MshText mesh({"base", "top", "sides"});
  for (int j = 0; j <= cells; ++j) {
    mesh.add_node(0.0, double(j) / cells);
    mesh.add_node(width, double(j) / cells);
  }
  mesh.add_edge(1, 1, 2);
  mesh.add_edge(2, 2 * cells + 1, 2 * cells + 2);
  for (int j = 0; j < cells; ++j) {
    const int a = 2 * j + 1, b = a + 1, c = a + 2, d = a + 3;  // lower left, lower right, upper left, upper right
    if (j > 0) {
      mesh.add_edge(3, a, c);
      mesh.add_edge(3, b, d);
    }
    mesh.add_quadrilateral(a, b, d, c);
  }
  return write_temporary(fmt::format("column{}.msh", cells), mesh.text());
}

/// Returns the part of a case that makes the column a shear column over a rough base at y = 0: density and shear
/// modulus 1, Poisson's ratio 0, sides that cannot move along y (they carry the complementary shear stress), pressed on
/// the base by `pressure`, which is applied at the base itself. `contact` is an additional line of [[contact]].
std::string column_case(const std::string& mesh, double pressure, const std::string& contact, int degree = 1) {
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"body\"\nlambda = 0.0\nmu = 1.0\ndensity = 1.0\n"
      "[[support]]\ngroup = \"sides\"\ncomponents = [\"y\"]\n"
      "[obstacle.base]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
      "[[contact]]\ngroup = \"base\"\nobstacle = \"base\"\n{}\n"
      "[[traction]]\ngroup = \"base\"\nvalue = [0.0, {:.17g}]\n",
      mesh, degree, contact, -pressure);
}

TEST(SlidingLayer, ClosedFormAgreesWithTheFormulasOfTheWaves) {
  const Layer layer{0.3};
  EXPECT_EQ(layer.phases(), 2);
  EXPECT_DOUBLE_EQ(layer.velocity(1.0), 0.7);
  EXPECT_DOUBLE_EQ(layer.velocity(3.0), 0.1);
  EXPECT_DOUBLE_EQ(layer.slip(), 1.6);
  EXPECT_DOUBLE_EQ(layer.traction(5.0), 0.2);
  EXPECT_DOUBLE_EQ(layer.traction(7.0), -0.2);
  for (const std::string a : {"0.15", "0.2", "0.3", "0.45", "1.5"}) {
    const Layer other{std::stod(a)};
    for (const auto& [quantity, x, time, value] : closed_forms("layer " + a)) {
      const double found = quantity == "slip"       ? other.slip()
                           : quantity == "velocity" ? other.velocity(time)
                                                    : other.traction(time);
      EXPECT_NEAR(found, value, 1e-10) << a << ' ' << quantity << ' ' << time;
    }
  }
  // Kinetic energy ½ at the start, D²/2 in the standing waves that remain; friction takes the difference, a × slip.
  for (const double a : {0.15, 0.2, 0.3, 0.45, 1.5}) {
    const Layer other{a};
    const double left = other.arriving(100);
    EXPECT_NEAR(0.5 - a * other.slip(), 0.5 * left * left, 1e-14) << a;
    EXPECT_LE(std::abs(left), a * (1.0 + 1e-14)) << a;
  }
}

struct Method {
  std::string name;
  std::string time;  ///< lines of [time]
  std::string mass;
};

const Method newmark{"newmark trapezoidal, equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                     "equivalent"};

struct Errors {
  double velocity = 0.0, traction = 0.0;             ///< relative, in L²(0, T)
  double slip = 0.0;                                 ///< at the end, relative
  double sticking = 0.0;                             ///< error of the time of sticking, in units of time
  double late_slip = 0.0;                            ///< total variation of the slip well after sticking, relative
  double friction_work = 0.0;                        ///< relative
  std::vector<double> mean_velocity, mean_traction;  ///< over the middle half of each phase
};

constexpr double end = 10.0;
constexpr double width = 0.5;

/// Mean over the middle half of each phase.
class PhaseMeans {
 public:
  void add(double t, double value) {
    const auto phase = std::size_t(t / 2.0);
    if (phase >= sums_.size() || std::abs(t - 2.0 * double(phase) - 1.0) > 0.5) return;
    sums_[phase] += value;
    counts_[phase] += 1.0;
  }
  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> means;
    for (std::size_t k = 0; k < sums_.size(); ++k) means.push_back(sums_[k] / counts_[k]);
    return means;
  }

 private:
  std::vector<double> sums_ = std::vector<double>(std::size_t(end / 2.0));
  std::vector<double> counts_ = sums_;
};

/// Relative error in L²(0, T).
struct RelativeError {
  double error = 0.0, size = 0.0;
  void add(double found, double exact) {
    error += (found - exact) * (found - exact);
    size += exact * exact;
  }
  [[nodiscard]] double value() const { return std::sqrt(error / size); }
};

/// Means over the base of a layer: the displacement along x, its rate over a step, and the traction on the layer.
struct Base {
  double displacement = 0.0, velocity = 0.0, traction = 0.0;

  explicit Base(CaseRun& run) {
    const ContactBoundary& contact = run.problem().contact;
    const auto mean = [&](const Vector& field) {
      double sum = 0.0;
      for (const Index node : contact.nodes) sum += field[2 * node];
      return sum / double(contact.nodes.size());
    };
    displacement = mean(run.state().displacement);
    velocity = mean(run.simulation().increment()) / run.scheme().step();
    const Vector& friction = run.state().forces.tangential_reaction;
    for (Index i = 0; i < contact.size(); ++i) {
      traction -= contact.rows->tangents[std::size_t(i)](0, 0) * friction[i] / contact.weights.sum();
    }
  }
};

/// Time at which the line through the middle of the last sliding phase reaches the final slip: a time of sticking that
/// does not depend on single steps.
double sticking_time(const Layer& layer, const std::vector<std::pair<double, double>>& slips) {
  const double middle = layer.sticking_time() - 1.0;
  std::vector<std::pair<double, double>> line;
  for (const auto& entry : slips) {
    if (std::abs(entry.first - middle) <= 0.5) line.push_back(entry);
  }
  const auto [t0, s0] = line.front();
  const auto [t1, s1] = line.back();
  return t0 + (slips.back().second - s0) * (t1 - t0) / (s1 - s0);
}

/// Runs the layer on `cells` cells with Δt = h/2.
Errors solve(const Layer& layer, const Method& method, int cells) {
  const double step = 0.5 / cells;
  const std::string contact = fmt::format("friction = {:.17g}", layer.a);  // pressure 1
  CaseRun run(column_case(column_mesh(width, cells), 1.0, contact) +
              fmt::format("[initial]\nvelocity = [1.0, 0.0]\n[mass]\ntype = \"{}\"\n[time]\n{}step = {:.17g}\nend = "
                          "{:.17g}\n",
                          method.mass, method.time, step, end));
  const std::string scheme = run.input().time.scheme;
  // Velocities are central differences at the time of the row, or differences over the preceding step.
  const double velocity_instant = scheme == "klr-conserving" ? 0.0 : -0.5;
  const double force_instant = scheme == "midpoint" ? -0.5 : 0.0;
  RelativeError velocity, traction;
  PhaseMeans mean_velocity, mean_traction;
  std::vector<std::pair<double, double>> slips;
  double late_slip = 0.0;
  run.run(
      [&] {
        const Base base(run);
        const double velocity_time = run.state().time + velocity_instant * step;
        const double force_time = run.state().time + force_instant * step;
        velocity.add(base.velocity, layer.velocity(velocity_time));
        traction.add(base.traction, layer.traction(force_time));
        mean_velocity.add(velocity_time, base.velocity);
        mean_traction.add(force_time, base.traction);
        slips.emplace_back(run.state().time, base.displacement);
        if (run.state().time > layer.sticking_time() + 0.5) late_slip += std::abs(base.velocity) * step;
      },
      false);
  const double exact_work = -layer.a * width * layer.slip();
  return {.velocity = velocity.value(),
          .traction = traction.value(),
          .slip = slips.back().second / layer.slip() - 1.0,
          .sticking = sticking_time(layer, slips) - layer.sticking_time(),
          .late_slip = late_slip / layer.slip(),
          .friction_work = run.simulation().account().works().friction / exact_work - 1.0,
          .mean_velocity = mean_velocity.values(),
          .mean_traction = mean_traction.values()};
}

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format(" {:.4f}", value);
  return text;
}

/// Prints the table of a layer and a method and returns the errors by refinement.
std::vector<Errors> table(const Layer& layer, const Method& method, const std::vector<int>& cells) {
  std::printf("a = %.2f, %s, dt = h/2c\n", layer.a, method.name.c_str());
  std::printf("%6s %9s %6s %9s %6s %10s %10s %10s %10s\n", "cells", "velocity", "order", "traction", "order", "slip",
              "sticking", "late slip", "work");
  std::vector<Errors> all;
  for (const int n : cells) {
    all.push_back(solve(layer, method, n));
    const Errors& e = all.back();
    const Errors& before = all[all.size() > 1 ? all.size() - 2 : 0];
    std::printf("%6d %9.2e %6.2f %9.2e %6.2f %10.2e %10.2e %10.2e %10.2e\n", n, e.velocity,
                std::log2(before.velocity / e.velocity), e.traction, std::log2(before.traction / e.traction), e.slip,
                e.sticking, e.late_slip, e.friction_work);
    std::printf("       velocity%s, traction%s\n", list(e.mean_velocity).c_str(), list(e.mean_traction).c_str());
  }
  return all;
}

double mean_order(const std::vector<Errors>& all, double Errors::*part) {
  return std::log2(std::abs(all.front().*part / all.back().*part)) / double(all.size() - 1);
}

/// The means over the middle of each phase, away from the fronts: velocities V − (1 + 2k) a, then none; traction −a,
/// then alternating.
void expect_phases(const Layer& layer, const Errors& e, double tolerance, const std::string& name) {
  for (std::size_t k = 0; k < e.mean_velocity.size(); ++k) {
    const double t = 2.0 * double(k) + 1.0;
    EXPECT_NEAR(e.mean_velocity[k], layer.velocity(t), tolerance) << name << ", phase " << k;
    EXPECT_NEAR(e.mean_traction[k], layer.traction(t), tolerance) << name << ", phase " << k;
  }
}

const std::vector<int> refinements{25, 50, 100, 200};

TEST(SlidingLayer, ThreeSlidingPhasesTwoAndOne) {
  for (const double a : {0.15, 0.3, 0.45}) {
    const Layer layer{a};
    const std::string name = fmt::format("a = {}", a);
    const std::vector<Errors> all = table(layer, newmark, refinements);
    EXPECT_GT(mean_order(all, &Errors::velocity), 0.4) << name;
    EXPECT_GT(mean_order(all, &Errors::traction), 0.35) << name;
    EXPECT_GT(mean_order(all, &Errors::slip), 0.7) << name;
    EXPECT_GT(mean_order(all, &Errors::friction_work), 0.7) << name;
    EXPECT_LT(std::abs(all.back().slip), 5e-3) << name;
    EXPECT_LT(std::abs(all.back().sticking), 0.02) << name;
    EXPECT_LT(all.back().late_slip, 5e-4) << name;
    expect_phases(layer, all.back(), 5e-4, name);
  }
}

// V/a − 1 = 4: in the last phase the wave brings exactly the traction a. At the limit between stick and slip the status
// is undetermined, and the overshoot of the fronts is slip. Traction and slip converge.
TEST(SlidingLayer, NeutralBetweenStickAndSlip) {
  const Layer layer{0.2};
  EXPECT_EQ(layer.phases(), 2);
  const std::vector<Errors> all = table(layer, newmark, refinements);
  EXPECT_GT(mean_order(all, &Errors::velocity), 0.4);
  EXPECT_GT(mean_order(all, &Errors::traction), 0.45);
  EXPECT_GT(mean_order(all, &Errors::slip), 0.45);
  EXPECT_LT(std::abs(all.back().slip), 5e-3);
  expect_phases(layer, all.back(), 4e-3, "neutral");
}

// With a > V the base does not slide at all. The massless nodes of the base relax over the first step, so they may move
// by V Δt.
TEST(SlidingLayer, SticksAtOnce) {
  const Layer layer{1.5};
  EXPECT_EQ(layer.phases(), 0);
  for (const int cells : refinements) {
    const double step = 0.5 / cells;
    CaseRun run(column_case(column_mesh(width, cells), 1.0, "friction = 1.5") +
                fmt::format("[initial]\nvelocity = [1.0, 0.0]\n[time]\n{}step = {:.17g}\nend = {:.17g}\n", newmark.time,
                            step, end));
    PhaseMeans traction;
    double slip = 0.0;
    run.run(
        [&] {
          const Base base(run);
          slip = std::max(slip, std::abs(base.displacement));
          traction.add(run.state().time, base.traction);
        },
        false);
    std::printf("a = 1.50, %3d cells: slip %.2e, traction%s\n", cells, slip, list(traction.values()).c_str());
    EXPECT_LT(slip, step * (1.0 + 1e-12));
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(traction.values()[k], k % 2 == 0 ? -1.0 : 1.0, 2.0 / cells);
  }
}

TEST(SlidingLayer, OtherSchemesAndMasses) {
  const Layer layer{0.3};
  const std::string half = "scheme = \"newmark\"\npreset = \"textbook-half\"\n";
  const std::string damped = "scheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\n";
  for (const Method& method :
       std::vector<Method>{{"newmark beta = gamma = 1/2, equivalent", half, "equivalent"},
                           {"newmark beta = gamma = 1/2, consistent", half, "consistent"},
                           {"newmark 0.3025, 0.6, equivalent", damped, "equivalent"},
                           {"newmark 0.3025, 0.6, consistent", damped, "consistent"},
                           {"newmark 0.3025, 0.6, lumped", damped, "lumped"},
                           {"reduced-kane, equivalent", "scheme = \"reduced-kane\"\n", "equivalent"},
                           {"reduced-kane adaptive, equivalent",
                            "scheme = \"reduced-kane\"\nreaction_weight = \"adaptive\"\n", "equivalent"},
                           {"midpoint, consistent", "scheme = \"midpoint\"\n", "consistent"},
                           {"midpoint, lumped", "scheme = \"midpoint\"\n", "lumped"},
                           {"klr-conserving, consistent", "scheme = \"klr-conserving\"\n", "consistent"},
                           {"klr-conserving, lumped", "scheme = \"klr-conserving\"\n", "lumped"},
                           {"semi-explicit", "scheme = \"semi-explicit\"\n", "equivalent-lumped"}}) {
    const std::vector<Errors> all = table(layer, method, refinements);
    EXPECT_GT(mean_order(all, &Errors::velocity), 0.25) << method.name;
    EXPECT_GT(mean_order(all, &Errors::traction), 0.25) << method.name;
    EXPECT_LT(std::abs(all.back().slip), 5e-3) << method.name;
    EXPECT_LT(all.back().late_slip, 1e-3) << method.name;
    expect_phases(layer, all.back(), 1e-3, method.name);
  }
}

// A sticking node with inertia has U₁ = U₀ in every step, so the trapezoidal rule gives V₁ = −V₀: the node keeps its
// initial speed, and the friction force alternates by 2 m V/h until it reaches the cone. This combination therefore
// continues to slide when it should stick, on every mesh.
TEST(SlidingLayer, TrapezoidalRuleWithInertiaOnContactNodesDoesNotStick) {
  const Method method{"newmark trapezoidal, consistent", newmark.time, "consistent"};
  for (const Errors& e : table({0.3}, method, {25, 50, 100})) {
    EXPECT_GT(e.late_slip, 0.05);
    EXPECT_NEAR(e.mean_velocity[0], 0.7, 2e-3);  // sliding is right
    EXPECT_NEAR(e.mean_velocity[1], 0.1, 2e-3);
  }
}

}  // namespace ricochet::test_support::friction_layer_test
